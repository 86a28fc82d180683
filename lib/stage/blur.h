/* Stage `blur`: an image convolved with the detector's line spread functions or its point spread function. Private.
 *
 * A pixel beyond the border takes the value of the nearest pixel on it. So a flat field that reaches the border continues
 * beyond it, and the blur leaves it unchanged. */
#ifndef SKG_BLUR_H
#define SKG_BLUR_H

#include "stage/attenuate.h"

typedef struct skg_blur skg_blur;

/* Checks and copies the functions, scaled to sum 1. SKG_ERR_ARGUMENT: an even or no number of samples, a sample that is
 * not finite, no positive sum. */
skg_status skg_blur_create(skg_context *context, const skg_detector_blur *shape, skg_blur **blur);
void skg_blur_release(skg_blur **blur);

/* Enqueues the blur of `channels` images of columns x rows, from one place to another or in place; image->add: the result is
 * added to what is there. The workspace is allocated at the first call. */
skg_status skg_blur_run(skg_blur *blur, const skg_image_place *from, const skg_image_place *image,
                        int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log);

/* Likewise enqueues what the blur makes of the variances of pixels that are independent of each other. */
skg_status skg_blur_run_variance(skg_blur *blur, const skg_image_place *from, const skg_image_place *image,
                                 int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log);

/* The transpose of the blur of one image, on the host in double precision: adds to `to`, [rows][columns]. A pixel on the border
 * takes what belongs to the pixels beyond it. */
skg_status skg_blur_transpose(const skg_blur *blur, int64_t columns, int64_t rows, const double *from,
                              double *to);

/* The blur of one image on the host in double precision: adds to `to`. */
void skg_blur_apply(const skg_blur *blur, int64_t columns, int64_t rows, const double *from, double *to);

/* From how many samples a pixel is summed. */
int64_t skg_blur_samples(const skg_blur *blur);

/* The functions in words: "a point spread function of 5 x 5 samples"; valid as long as the blur. */
const char *skg_blur_kind(const skg_blur *blur);

/* Bytes on the device. */
int64_t skg_blur_bytes(const skg_blur *blur);

#endif
