/** @file
 * The detector's blur: spread functions, blur by depth, noise power by spatial frequency.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BLUR_H
#define SKIAGRAPH_BLUR_H

#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The detector's blur: what a point or a line becomes, sampled one pixel apart. Prepare with
 * skg_detector_blur_init.
 *
 * Give two line spread functions, whose product is the point spread function, or the point spread function
 * itself. Numbers of samples are odd, 1 to 4095; sample k of n is the share of a pixel's value that is found
 * k - n/2 pixels further on. Samples are scaled to the sum 1. A pixel beyond the edge of the image has the
 * value of the nearest edge pixel. Samples that were made for pixels of a certain size say so in pixel_mm: a plan for
 * others is refused, and a view that has others makes a plan SKG_STALE. */
typedef struct {
    /** Set by skg_detector_blur_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of samples along a row. */
    int64_t columns;
    /** Number of samples along a column. */
    int64_t rows;
    /** [columns] line spread function along a row */
    const double *along_row;
    /** [rows] line spread function along a column */
    const double *along_column;
    /** [rows][columns] point spread function; NULL: the two line spread functions */
    const double *point;
    /** mm between pixels along a row and along a column for which the samples were made, as by skg_line_spread_get; 0
     * (default): they are of pixels of any size */
    double pixel_mm[2];
} skg_detector_blur;

SKG_INIT(skg_detector_blur)

/** Gets the line spread function of a modulation transfer function, for skg_detector_blur: the fewest samples whose
 * transfer function is within 0.005 of the table at all frequencies that the pixels show. Rows are joined by curves of
 * third degree that rise or fall as the rows do.
 *
 *     count      number of frequencies, at least 2
 *     per_mm     [count] line pairs per mm, rising from 0 to at least 1 / (2 pixel_mm)
 *     mtf        [count] 1 at frequency 0, values from -2 to 2
 *     pixel_mm   distance of the pixels along the line
 *     line       result: [SKG_LINE_SAMPLES_MAX], of which the first `samples` are set
 *     samples    result: odd
 *     errors     SKG_ERR_ARGUMENT, with the row of the table
 *
 * A presampling MTF (IEC 62220-1) holds the aperture of the pixels. With supersampling, the image has this aperture
 * already: divide by it then. */
SKG_API skg_status skg_line_spread_get(int64_t count, const double *per_mm, const double *mtf,
                                       double pixel_mm, double *line, int64_t *samples);

/** Blur that depends on the depth at which photons interact in a scintillator: light from far off the sensor spreads
 * most. Photons that interact in a depth make an image of their own, with their own noise, and this is blurred as the
 * depth says; the images are added. So the blur depends on the energy, and noise power falls less with the frequency
 * than the square of the MTF (G. Lubberts, Random noise produced by x-ray fluorescent screens, Journal of the Optical
 * Society of America 58 (1968) 1475-1483). Prepare with skg_depth_blur_init.
 *
 * method   exp(-mu z) along the straight path, for the first interaction; neither obliquity nor fluorescence
 *          changes the shares of the depths */
typedef struct {
    /** Set by skg_depth_blur_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of depths, 1 to SKG_DEPTHS_MAX. Depths times channels are at most SKG_CHANNELS_MAX. */
    int64_t count;
    /** [count] where each depth ends, from the side on which photons enter: shares of the thickness, rising, the
     * last is 1 */
    const double *to;
    /** [count] the blur of each depth */
    const skg_detector_blur *blur;
} skg_depth_blur;

SKG_INIT(skg_depth_blur)

/** A measured detective quantum efficiency by spatial frequency, for the power of the noise. Prepare with
 * skg_dqe_init.
 *
 * The noise of a flat field of the plan's beam has, along rows and columns, the power
 * NPS(f) = mean^2 MTF(f)^2 / (q DQE(f)) with q photons per mm2 and the MTF of the plan's blur; off the axes DQE(f) /
 * DQE(0) is the product of both directions. DQE(0) determines the variance, so it replaces the Swank factors; behind
 * a part, the variance of each energy changes as its intensity does. */
typedef struct {
    /** Set by skg_dqe_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of frequencies, at least 2. */
    int64_t count;
    /** [count] line pairs per mm, rising from 0 to at least 1 / (2 pixel size) */
    const double *per_mm;
    /** [count] above 0 to 1; that at 0 is at most what the response allows for the beam */
    const double *dqe;
} skg_dqe;

SKG_INIT(skg_dqe)

#ifdef __cplusplus
}
#endif
#endif
