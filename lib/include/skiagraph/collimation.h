/** @file
 * Jaws that limit the beam.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_COLLIMATION_H
#define SKIAGRAPH_COLLIMATION_H

#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Kinds of collimation. */
enum skg_collimation_kind {
    /** Nothing. */
    SKG_COLLIMATION_OPEN = 0,
    /** Jaws that leave a rectangle open. */
    SKG_COLLIMATION_RECTANGLE = 1,
    /** The rectangle of the detector, with a margin. */
    SKG_COLLIMATION_DETECTOR = 2
};

/** A collimator: jaws between source and detector that stop every ray outside a rectangle, the field. Prepare with
 * skg_collimation_init: no limits.
 *
 * The rectangle lies in a plane parallel to the detector, and its sides along the detector's column and row steps.
 * SKG_COLLIMATION_RECTANGLE: its coordinates are measured from the point where the ray from the middle of the source to the
 * detector's centre crosses the plane. SKG_COLLIMATION_DETECTOR: the outer edges of the detector's pixels, moved outward by
 * `margin_mm`, on the plane of the detector. The collimator moves with source and detector when frames have other views.
 *
 * method   each ray passes or is stopped: that from a sample of the source to the centre of a pixel or, with
 *          supersampling, to the middle of a piece of it. So an extended source of width f casts a penumbra f (D - d) / d
 *          wide, with the distances D of the detector and d of the jaws. A ray within 1e-9 pixels of an edge lies on it;
 *          those on the edges `low` pass, those on `high` do not. Jaws are opaque and without thickness: there is neither
 *          leakage nor scatter from their edges, and no radiation from outside the focal spot.
 *
 * In a parallel beam the rectangle is carried along the beam, and distance_mm has no effect. Path lengths are not
 * limited. Ratios are to the flat field without jaws: behind them the transmission is 0, and the attenuation is the logarithm of
 * the smallest normal float, 87.34. */
typedef struct {
    /** Set by skg_collimation_init. */
    int32_t size;
    /** enum skg_collimation_kind */
    int32_t kind;
    /** Distance of the rectangle: from the middle of the source to its plane, along the detector's normal, mm. Above 0, beyond the
     * focal spot, and at most the distance of the detector. */
    double distance_mm;
    /** Lowest coordinates of the rectangle along the column step and along the row step, mm. */
    double low[2];
    /** Highest coordinates of the rectangle, above the lowest, mm. */
    double high[2];
    /** Margin of the detector's rectangle, mm on the detector; below 0: the field is smaller. */
    double margin_mm;
} skg_collimation;

SKG_INIT(skg_collimation)

/** Gets the corners of the field of a view's beam. Points between them on the detector see the middle of the source.
 *
 *     collimation   NULL: open, which gives the corners of the detector
 *     on_jaws       1: where the field passes the plane of the jaws, which is that of the detector without
 *                   SKG_COLLIMATION_RECTANGLE and in a parallel beam; 0: where it meets the detector's plane
 *     corners       result: [4][3] mm, in the order low column and low row, high and low, high and high, low and high
 *     errors        SKG_ERR_ARGUMENT or SKG_ERR_SCENE for numbers that are not usable, jaws behind the detector, and a margin
 *                   that leaves nothing of it; as skg_view_check for the view
 *     method        the rectangle of the jaws, carried from the middle of the source, or along a parallel beam */
SKG_API skg_status skg_collimation_corners_get(const skg_collimation *collimation, const skg_view *view,
                                               int32_t on_jaws, double *corners);

#ifdef __cplusplus
}
#endif
#endif
