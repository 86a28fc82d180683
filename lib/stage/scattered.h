/* Stage `scattered`: adds scattered photons to an image, with their noise. Private. */
#ifndef SKG_SCATTERED_H
#define SKG_SCATTERED_H

#include "stage/attenuate.h"

/* The kernels: of images of float and double, without and with noise, and with noise apart; made on demand. All zero: none. */
typedef struct {
    cl_kernel kernels[2][3];
} skg_scattered;

/* What is added: [channels][rows][columns] floats. variance: NULL: no noise. */
typedef struct {
    cl_mem mean, variance;
    int32_t channels;
    int32_t add;   /* 1: to what the image holds; 0: in its place */
    int32_t apart; /* 1: deviations go to images behind those of all channels */
    float scale;   /* of what is added */
} skg_scattered_image;

skg_status skg_scattered_run(skg_context *context, skg_scattered *stage, const skg_scattered_image *what,
                             const skg_noise_args *key, const skg_image_place *image, int64_t columns,
                             int64_t rows, skg_stage_log *log);
void skg_scattered_release(skg_scattered *stage);

#endif
