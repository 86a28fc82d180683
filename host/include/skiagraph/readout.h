/** @file
 * Grey values: what a detector writes for the energy that its pixels collect. The noise is that of a specification of
 * the finished image; for noise from the photons themselves see skg_plan_options.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_READOUT_H
#define SKIAGRAPH_READOUT_H

#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How a detector is read out. Prepare with skg_readout_init: 0 without radiation, 60000 where the free beam is strongest,
 * 16 bits, no noise, no bad pixels, all pixels alike. A pixel passes through these steps: grey value of its energy, its gain and
 * offset, noise, saturation, bad pixels, whole numbers. */
typedef struct {
    /** Set by skg_readout_init. */
    int32_t size;
    /** 8 to 16: whole numbers from 0 to 2^bits - 1. 0: numbers as they are. */
    int32_t bits;
    /** Grey value without radiation. */
    double dark;
    /** Grey value at full_kev. */
    double full;
    /** Energy of a pixel where the free beam is strongest, keV; above 0. */
    double full_kev;
    /** Grey values for each joule, added to `dark`, instead of `full`; 0: none. */
    double per_joule;
    /** Number of points of `curve`; 0: none. */
    int64_t curve_count;
    /** [curve_count][2] energy of a pixel in joules, rising, and its grey value, instead of `dark` and `full`; linear
     * between them, and beyond them as between the nearest two. */
    const double *curve;
    /** Ratio of grey value to standard deviation at full_kev. The variance is proportional to the energy. 0: no noise. */
    double snr;
    /** Number of points of `noise`; 0: none. */
    int64_t noise_count;
    /** [noise_count][2] grey value, rising, and its ratio to the standard deviation, instead of `snr`. */
    const double *noise;
    /** Number of frames that are averaged; the variance is divided by it. 1 by default. */
    int64_t frames;
    /** [pixels] grey values of bad pixels, and -1 for each good one; NULL: all are good. */
    const float *bad_pixels;
    /** Seed of the noise. */
    int64_t seed;
    /** [pixels] factor of each pixel, finite and at least 0, on its grey value beyond that without radiation, and on the standard
     * deviation of its noise; NULL: 1. */
    const float *gain;
    /** [pixels] grey value of each pixel, finite, added to all of its values, such as its dark current; NULL: 0. */
    const float *offset;
    /** Grey value at which pixels saturate; 0: none, but for the bits. */
    double saturation;
    /** Number of terms of `lag`; 0: none. */
    int64_t lag_count;
    /** [lag_count][2] of a sequence, as of skg_lag_create. skg_readout_image, which has no past, does without. */
    const double *lag;
    /** Number of terms of `ghosting`; 0: none. */
    int64_t ghosting_count;
    /** [ghosting_count][2] likewise, as of skg_lag_ghosting_set with full_kev. */
    const double *ghosting;
} skg_readout;

SKG_INIT(skg_readout)

/** Reads an image out.
 *
 *     readout   its full_kev has to be set
 *     pixels    number of pixels
 *     type      of energies: SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64
 *     energies  [pixels] keV; NULL: no radiation (a dark field)
 *     share     factor on all energies
 *     index     number of the image: with the seed, it decides the noise
 *     grey      result: [pixels] uint16_t if readout->bits is not 0, otherwise float
 *     errors    SKG_ERR_ARGUMENT (a field of the readout) */
SKG_API skg_status skg_readout_image(const skg_readout *readout, int64_t pixels, int32_t type,
                                     const void *energies, double share, int64_t index, void *grey);

/** The lag of a detector: what its pixels hold back of the frames of a sequence, and how these change their sensitivity. */
typedef struct skg_lag skg_lag;

/** Makes the lag of a detector at rest.
 *
 *     pixels   number of pixels, at least 1
 *     count    number of terms, 0 to 8
 *     terms    [count][2] share of the signal that is held back, 0 or more, all together below 1; and the time constant of its
 *              release in frames, above 0
 *     lag      result; the caller releases it
 *     errors   SKG_ERR_ARGUMENT
 *     method   In each frame a share s of the signal is caught, and of what was held before, 1 - exp(-1/t) is set free. So the n-th frame
 *              after a long exposure shows the sum of s exp(-(n - 1) / t) of its signal; a steady signal is shown as it is; and no signal is
 *              lost. The sensitivity does not change without skg_lag_ghosting_set. */
SKG_API skg_status skg_lag_create(int64_t pixels, int64_t count, const double *terms, skg_lag **lag);

/** Gives a detector ghosting: what its pixels received changes their sensitivity to what comes next.
 *
 *     full     signal of the open beam in a frame, in the unit of the frames, above 0
 *     count    number of terms, 1 to 8
 *     terms    [count][2] change of the sensitivity after a long exposure to `full`, above -1 together and finite; and the time constant,
 *              in frames, with which it builds up and goes, above 0
 *     errors   SKG_ERR_ARGUMENT
 *     method   The sensitivity is 1 + sum c q, but not below 0, where each q goes in each frame by 1 - exp(-1/t) of the way to signal / full. What a pixel
 *              receives is multiplied by it before the lag. Flat fields of a rested detector do not take it away. */
SKG_API skg_status skg_lag_ghosting_set(skg_lag *lag, double full, int64_t count, const double *terms);

/** Frees a lag. */
SKG_API void skg_lag_release(skg_lag **lag);

/** Lets the detector come to rest: nothing is held, and the sensitivity is 1. */
SKG_API skg_status skg_lag_clear(skg_lag *lag);

/** Shows the next frame of a sequence.
 *
 *     type       of energies and result: SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64
 *     energies   [pixels] keV; NULL: no radiation
 *     factor     on all energies
 *     result     [pixels] keV; may be `energies` */
SKG_API skg_status skg_lag_apply(skg_lag *lag, int32_t type, const void *energies, double factor,
                                 void *result);

#ifdef __cplusplus
}
#endif
#endif
