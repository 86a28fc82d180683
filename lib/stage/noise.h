/* Stage `detect`: what follows quantum noise and blur. Electronic noise, quantisation, and the quantity that
 * is shown. Private.
 *
 * Quantum noise itself is drawn where intensities are made (attenuate.h): there the photons of every node are
 * at hand, so that few of them are drawn exactly; sums of draws for several samples of the source are
 * distributed as a draw of the sum. */
#ifndef SKG_NOISE_H
#define SKG_NOISE_H

#include "stage/attenuate.h"

typedef struct {
    double electronic; /* standard deviation, keV per pixel; 0: none */
    double step;       /* keV per pixel; 0: any value */
    int32_t channels;
    int32_t over_field; /* 1: values are divided by those of an open field */
} skg_detection;

typedef struct skg_detector skg_detector;

/* factors: [channels] of values, after quantisation; copied. */
skg_status skg_detector_create(skg_context *context, const skg_detection *detection, const double *factors,
                               skg_detector **detector);
void skg_detector_release(skg_detector **detector);

/* Enqueues it for an image of columns x rows, in place. factor: of this frame, for all channels. field:
 * [channels][rows][columns] of the image's type, where the detection is over it. */
skg_status skg_detector_run(skg_detector *detector, const skg_noise_args *key, double factor, cl_mem field,
                            const skg_image_place *image, int64_t columns, int64_t rows, skg_stage_log *log);

int64_t skg_detector_bytes(const skg_detector *detector);

/* The key of a frame. */
skg_noise_args skg_noise_key(int64_t seed, int64_t index);

#endif
