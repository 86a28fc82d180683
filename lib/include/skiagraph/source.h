/** @file
 * Emission of the source over space and direction: focal spot, falloff, heel effect, bow-tie filter.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SOURCE_H
#define SKIAGRAPH_SOURCE_H

#include <skiagraph/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Shapes of the focal spot. A flat one lies across the line from the source to the detector's centre, with
 * its width along the projected column step. */
enum skg_spot_shape {
    /** A point. */
    SKG_SPOT_POINT = 0,
    /** extent[0] along the width */
    SKG_SPOT_LINE = 1,
    /** extent[0] x extent[1] */
    SKG_SPOT_RECTANGLE = 2,
    /** extent[0] x extent[1] x extent[2], the last along the line to the detector */
    SKG_SPOT_CUBE = 3,
    /** diameter extent[0] */
    SKG_SPOT_DISC = 4,
    /** a filled sphere of diameter extent[0] */
    SKG_SPOT_SPHERE = 5,
    /** full widths at half maximum extent[0] x extent[1], the effective sizes of IEC 60336 */
    SKG_SPOT_GAUSSIAN = 6
};

/** The focal spot. Prepare with skg_spot_init: a point.
 *
 * Its samples have equal weights, so that the flat field depends neither on the shape nor on their number.
 * They follow Sobol's sequence: more samples continue fewer. */
typedef struct {
    /** Set by skg_spot_init. */
    int32_t size;
    /** enum skg_spot_shape */
    int32_t shape;
    /** Full widths, mm. */
    double extent[3];
    /** Normal of a flat shape; all 0: the line to the detector's centre. */
    double axis[3];
    /** Number of samples, 1 to 65536. 0: adaptive sampling. The number is doubled while the plan is made, for
     * the plan's view, until two doublings in a row change 99.9 % of the pixels by less than `tolerance`. */
    int64_t samples;
    /** n > 0: instead, the middles of n (line), n x n (rectangle) or n x n x n (cube) equal pieces, as in
     * Vidal and Villard 2016. */
    int64_t grid;
    /** Tolerance of adaptive sampling, as a fraction of the flat field; 5e-3 by default. */
    double tolerance;
    /** Adaptive sampling stops at this number of samples; 1024 by default. */
    int64_t samples_max;
    /** Off-focal radiation: the share of the photons that leave the anode beside the focal spot, from a disc of diameter off_focal_mm around
     * its middle, with the same spectrum; 0 to below 1. 0 (default): none. Needs a focal spot that is no point, and no grid. */
    double off_focal;
    /** Diameter of that disc, mm, above 0 to 1000; without effect if off_focal is 0. */
    double off_focal_mm;
} skg_spot;

SKG_INIT(skg_spot)

/** The heel effect: photons leave the anode at an angle that differs over the detector, and the shallower it
 * is, the more of them the anode absorbs, the soft ones above all. Prepare with skg_heel_init; set kvp and
 * direction. The spectrum of the plan is that of the ray from the source to the detector's centre.
 *
 * method   the ratio of the spectra of Ebel's tube model at the angle of a ray and at angle_deg, for each
 *          energy. Filters are crossed straight, whatever the ray. */
typedef struct {
    /** Set by skg_heel_init. */
    int32_t size;
    /** Atomic number of the anode; 74 by default. */
    int32_t anode;
    /** Tube voltage in kV; no photon of the spectrum may have more energy. */
    double kvp;
    /** Angle between the anode's face and the ray to the detector's centre, degrees; 12 by default. */
    double angle_deg;
    /** Width of the bins of the spectrum, keV; 1 by default. */
    double bin_kev;
    /** From the detector's centre towards the side of the anode, where the image is darkest; any length. What
     * lies along the central ray does not count. It turns with the detector when frames have other views. */
    double direction[3];
} skg_heel;

SKG_INIT(skg_heel)

/** A bow-tie filter: a body at the source whose thickness changes along the fan of rays and not across it. Prepare
 * with skg_bowtie_init; set material, count, angle_deg and path_mm.
 *
 * The fan's plane contains the ray to the detector's centre. The path of a ray in this plane is linear in the
 * tangent of its angle between rows; that of a ray which leaves the plane by an angle k is longer by 1 / cos k,
 * as the body is the same all along the direction across the fan. The filter moves with source and detector. */
typedef struct {
    /** Set by skg_bowtie_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Material of the filter, of known density; retained. */
    skg_material *material;
    /** Number of rows, 2 to 4096. */
    int64_t count;
    /** [count] angle to the ray to the detector's centre, degrees, -89 to 89, rising. No ray of the plan's views
     * may lie outside. */
    const double *angle_deg;
    /** [count] path of the ray at this angle through the filter, mm, at least 0 */
    const double *path_mm;
    /** In which angles grow; any length. What lies along the ray to the detector's centre does not count. All 0:
     * along the detector's rows. It turns with the detector when frames have other views. */
    double direction[3];
} skg_bowtie;

SKG_INIT(skg_bowtie)

/** Falloff: intensity falls with the cube of the distance from the source (inverse square and obliquity). Photons per
 * pixel of the spectrum are then those at the foot of the perpendicular from the source to the plane of the detector,
 * whether or not a pixel lies there. */
enum skg_falloff {
    /** On if the spectrum is absolute (beam.h), off otherwise. */
    SKG_FALLOFF_AUTO = -1,
    /** Every pixel of the open beam receives the same. */
    SKG_FALLOFF_OFF = 0,
    /** On. */
    SKG_FALLOFF_ON = 1
};

#ifdef __cplusplus
}
#endif
#endif
