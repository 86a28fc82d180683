/* Reads the sums of the last frame before they are smoothed: by batch, kind and place. */
#ifndef SKG_TESTS_SCATTER_SUMS_H
#define SKG_TESTS_SCATTER_SUMS_H

#include <skiagraph/context.h>
#include <skiagraph/frame.h>

/* Planes: Rayleigh scattering alone of orders 1, 2 and higher; the same with Compton scattering; what adds to the variance. */
enum { SUMS_BATCHES = 32, SUMS_KINDS = 6, SUMS_PLANES = 7 };

/* sums: [SUMS_BATCHES][SUMS_PLANES][places] of a plan of one channel */
skg_status sums_read(skg_context *context, const skg_plan *plan, int64_t *sums);

/* Reads the images of the layers and channels of the last image. means: [layers][channels][rows][columns], count in all */
skg_status staged_read(skg_context *context, const skg_plan *plan, int64_t count, float *means);

#endif
