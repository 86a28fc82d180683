/* Stage `detect`: what follows quantum noise and blur: electronic noise, quantisation, and the quantity that is shown.
 * Private.
 *
 * Quantum noise itself is drawn where intensities are made (attenuate.h): there the photons of every node are known, so
 * that few photons can be drawn exactly. The sum of draws for several samples of the source has the distribution of one
 * draw of the sum. */
#ifndef SKG_DETECT_H
#define SKG_DETECT_H

#include "stage/attenuate.h"

typedef struct {
    double electronic; /* standard deviation, keV per pixel; 0: none */
    double step;       /* keV per pixel; 0: values are not quantised */
    int32_t channels;
    int32_t over_flat_field; /* 1: values are divided by those of a flat field */
} skg_detection;

typedef struct skg_detector skg_detector;

/* factors: [channels] of values, after quantisation; copied. */
skg_status skg_detector_create(skg_context *context, const skg_detection *detection, const double *factors,
                               skg_detector **detector);
void skg_detector_release(skg_detector **detector);

/* Whether values are divided by those of a flat field. */
int skg_detector_wants_flat_field(const skg_detector *detector);

/* Enqueues the stage for an image of columns x rows, in place. of_mean: 1: without electronic noise and steps. factor: of this
 * frame, for all channels. flat_field: [channels][rows][columns] of the image's type, if the detector wants it. */
skg_status skg_detector_run(skg_detector *detector, const skg_noise_args *key, int32_t of_mean, double factor,
                            cl_mem flat_field, const skg_image_place *image, int64_t columns, int64_t rows,
                            skg_stage_log *log);

/* Likewise enqueues what the stage makes of the variances of pixels. mean: [channels][rows][columns] of the transmission, if
 * variances are those of its -ln; else NULL. */
skg_status skg_detector_run_variance(skg_detector *detector, const skg_noise_args *key, double factor,
                                     cl_mem flat_field, cl_mem mean, const skg_image_place *variance,
                                     int64_t columns, int64_t rows, skg_stage_log *log);

/* Bytes on the device. */
int64_t skg_detector_bytes(const skg_detector *detector);

/* The key of a frame's noise. */
skg_noise_args skg_noise_key(int64_t seed, int64_t index, int32_t parts);

#endif
