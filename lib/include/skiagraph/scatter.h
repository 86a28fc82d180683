/** @file
 * Scattered photons, and the grid against them.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCATTER_H
#define SKIAGRAPH_SCATTER_H

#include <skiagraph/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An anti-scatter grid on the detector: strips that stand on it, with an interspace between them. Prepare with
 * skg_grid_init; set ratio, lines_per_cm and strip_mm.
 *
 * Its effect is the share of the primary photons that it lets pass, averaged over the place where a ray meets the
 * pattern of strips: the pattern itself is not shown, as with a grid that moves. Strips stop rays that are not
 * along them (cut-off), when the source is not at the focus or the beam is parallel. */
typedef struct {
    /** Set by skg_grid_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Height of the strips over the width of an interspace, above 0 to 100. */
    double ratio;
    /** Strips per cm. */
    double lines_per_cm;
    /** Thickness of a strip, mm, above 0 and less than its share of a cm. */
    double strip_mm;
    /** Material of the strips; retained. NULL: lead. */
    skg_material *strip;
    /** Material between the strips; retained. NULL: vacuum. */
    skg_material *interspace;
    /** Distance in mm from the grid to the line in which the planes of all strips meet, above the detector's
     * centre; 0: the strips are parallel. */
    double focus_mm;
    /** Across the strips; any length. What lies along the detector's normal does not count. All 0: along the
     * detector's rows. It turns with the detector when frames have other views. */
    double direction[3];
} skg_grid;

SKG_INIT(skg_grid)

/** Gets the share of the photons of an energy that pass a grid without interaction.
 *
 *     oblique        path of the ray between the faces of the grid divided by their distance, at least 1
 *     tilt           distance that the ray moves across the strips divided by the height of these; 0: along the
 *                    strips
 *     transmission   result: above 0 to 1
 *     method         mean over the period of exp(-mu_strip l - mu_interspace (H - l)) with the length l in strips
 *                    of the ray's path H, in closed form. Strips are plates without curvature, whose distance is
 *                    that on the detector.
 *     errors         SKG_ERR_SCENE for unusable dimensions; SKG_ERR_MATERIAL if a density is unknown */
SKG_API skg_status skg_grid_transmission_get(const skg_grid *grid, double energy_kev, double oblique,
                                             double tilt, double *transmission);

/** Fluorescence of the parts, with scatter: K and L lines after photo absorption. */
enum skg_fluorescence {
    /** Lines of elements from Z = 30 on whose edge is below the beam's highest energy. */
    SKG_FLUORESCENCE_AUTO = 0,
    /** Lines of lighter elements from Z = 20 on, too. */
    SKG_FLUORESCENCE_ON = 1,
    /** No lines: absorbed photons are gone. */
    SKG_FLUORESCENCE_OFF = 2
};

/** Scattered photons: what the object sends to the detector after one or more interactions. Prepare with
 * skg_scatter_init: to 1 % of the mean.
 *
 * method   Monte Carlo on the device, through cells that hold a medium, or the faces of the parts in them. Photons are made
 *          to interact and to survive; from each interaction they contribute to directions to the detector. The first
 *          interactions follow a lattice of points in place of random numbers. What arrives is counted on a coarse grid of
 *          the detector and smoothed by cosines, as many as independent batches show to pay.
 * physics  photo absorption, Compton scattering (Klein and Nishina, times the scattering functions of free atoms),
 *          Rayleigh scattering (form factors of free atoms); cross sections of XCOM, as for the primary; fluorescence in any
 *          direction (K and L lines; yields and rates of xraylib; of L shells the mean of their lines); pair production, whose positron
 *          stops where it is and sends two photons of 511 keV. Left out: Doppler broadening, the order of molecules unless materials have tables of it (skg_material_create_form_factor), bremsstrahlung, what the
 *          detector itself scatters.
 * field    without skg_plan_options.collimation the beam that scatters is limited to the detector, from its pixels'
 *          outer edges on */
typedef struct {
    /** Set by skg_scatter_init. */
    int32_t size;
    /** enum skg_fluorescence; SKG_FLUORESCENCE_AUTO by default */
    int32_t fluorescence;
    /** Standard error aimed at, smoothing included, over the mean of the scatter: root mean square over the detector. 0.01
     * by default; 0: `histories` decides. */
    double tolerance;
    /** Photons from the source, 0 to 2^30; 0 (default): as many as the tolerance needs. */
    int64_t histories;
    /** Seed of the histories. Frames with the same scene, view and seed have the same scatter. */
    int64_t seed;
    /** Sides of the cells, mm, about; 0 (default): 64 cells along each side of the box of all parts. Cells in
     * which parts differ hold their faces, however large they are. At most 128 along each side. */
    double voxel_mm;
    /** Places of the detector, along its rows and columns, that arriving photons are counted in; 0 (default): 32 along the
     * longer side, at most one for a pixel. At most 256. */
    int64_t columns;
    /** Likewise, along its columns. */
    int64_t rows;
} skg_scatter;

SKG_INIT(skg_scatter)

#ifdef __cplusplus
}
#endif
#endif
