/** @file
 * Types that several headers use: what a pixel holds, how exactly it is computed, and from where it is
 * seen.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_TYPES_H
#define SKIAGRAPH_TYPES_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A plan: how images of one scene are computed (plan.h). */
typedef struct skg_plan skg_plan;

/** Work that was submitted and may not be finished (frame.h). */
typedef struct skg_job skg_job;

/** Scatter of a series of frames (scatter_series.h). */
typedef struct skg_scatter_series skg_scatter_series;

/** Element type of an image in memory. */
enum skg_type {
    /** float, 32 bits */
    SKG_TYPE_FLOAT32 = 0,
    /** double, 64 bits */
    SKG_TYPE_FLOAT64 = 1,
    /** uint16_t: grey values (readout.h), which only files and pictures have */
    SKG_TYPE_UINT16 = 2
};

/** With which precision path lengths and images are computed. */
enum skg_precision {
    /** Terms in float, sums exact in integers. */
    SKG_PRECISION_SINGLE = 0,
    /** Terms in double, sums exact in 64-bit integers. Needs a device with fp64. */
    SKG_PRECISION_DOUBLE = 1,
    /** Distances and images in 16 bits as in Vidal and Villard 2016, for comparison. */
    SKG_PRECISION_HALF = 2
};

/** Quantity and unit of a pixel's value. I0 is the flat field: the same beam and detector without noise and without parts. */
enum skg_quantity {
    /** keV per pixel; the paper's "energy fluence" */
    SKG_QUANTITY_ENERGY = 0,
    /** energy fluence as ICRU 85 defines it, keV/mm2 */
    SKG_QUANTITY_FLUENCE = 1,
    /** photons per pixel */
    SKG_QUANTITY_PHOTONS = 2,
    /** I / I0 */
    SKG_QUANTITY_TRANSMISSION = 3,
    /** -ln(I / I0). An I / I0 below 2^-126, such as that of a noisy pixel without photons, counts as 2^-126
     * where the logarithm is taken of a finished image (with noise, blur, electronic noise, steps or several
     * rays a pixel): no attenuation is then above 126 ln 2 = 87.34. Without these it has no such limit. */
    SKG_QUANTITY_ATTENUATION = 4
};

/** How photons of different energies count in ratios of a band to its flat field. */
enum skg_band_weight {
    /** Every recorded photon counts 1, as in a photon-counting detector. */
    SKG_BAND_WEIGHT_PHOTONS = 0,
    /** Every recorded photon counts by its recorded energy. */
    SKG_BAND_WEIGHT_ENERGY = 1
};

/** Where rays start. */
enum skg_projection {
    /** At the point skg_view.source. */
    SKG_PROJECTION_POINT = 0,
    /** On the plane through skg_view.source that is perpendicular to the line from there to the detector's
     * centre; rays are parallel to that line. */
    SKG_PROJECTION_PARALLEL = 1,
    /** Infinitely far away; rays are parallel to skg_view.source, which is a direction. */
    SKG_PROJECTION_PARALLEL_FROM_INFINITY = 2
};

/** Source and detector. Prepare with skg_view_init: point source, everything else 0. A view that can be
 * imaged passes skg_view_check.
 *
 * The centre of the pixel in row r and column c is
 *
 *     centre + (c - (columns - 1) / 2) column_step + (r - (rows - 1) / 2) row_step,
 *
 * or where a radius bends it to.
 *
 * Path lengths are measured from the source, or from its plane, to that point. A pixel behind the plane sees
 * nothing. No entry may exceed 1e9 mm. */
typedef struct {
    /** Set by skg_view_init. */
    int32_t size;
    /** enum skg_projection */
    int32_t projection;
    /** Number of columns, 1 to 32768. */
    int64_t columns;
    /** Number of rows, 1 to 32768. */
    int64_t rows;
    /** Position in mm; with SKG_PROJECTION_PARALLEL_FROM_INFINITY a direction of any length. */
    double source[3];
    /** Centre of the detector, mm. */
    double centre[3];
    /** From one column to the next, mm. */
    double column_step[3];
    /** From one row to the next, mm. */
    double row_step[3];
    /** Radius in mm of the cylinder on which the columns stand; 0, the default: the detector is flat. The cylinder touches the
     * flat detector of this view in its middle, its axis is parallel to row_step, which is perpendicular to column_step,
     * and lies on the side of the source: where the radius is the distance of source and detector, it goes through the source. A
     * column is |column_step| mm along the cylinder from the next, and no more than 75 degrees from the middle. */
    double radius;
} skg_view;

SKG_INIT(skg_view)

/** Limits of the interface. */
enum skg_limit {
    /** Most channels of an image. */
    SKG_CHANNELS_MAX = 16,
    /** Most depths of a scintillator that have a blur of their own. */
    SKG_DEPTHS_MAX = 8,
    /** Most samples of a line spread function that is made from a table of frequencies. */
    SKG_LINE_SAMPLES_MAX = 255
};

#ifdef __cplusplus
}
#endif
#endif
