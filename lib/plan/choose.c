#include "stage/raster.h"

#include <skiagraph/plan.h>

/* Measured on two cores (Zen 3, AVX2, PoCL 3.1), spheres, project + raster + resolve, least of 3 x 21 frames,
 * ms: triangles, detector      copies   bands   atomics 41,616,    512^2           0.86    1.16      3.44
 *     41,616,    1024^2          1.94    2.21
 *     168,100,   2048^2         10.4     9.42
 *     1,000,000, 2048^2         21.1    24.4
 * Copies cost two passes over the image for each worker, bands about 10 ns a triangle and worker: bands win
 * where the image is large and the triangles are not small. The line for many workers is an estimate by the
 * same costs; what a GPU does best has not been measured. */
enum {
    FEW_WORKERS = 4,
    LARGE_IMAGE = 8 << 20, /* bytes of a private copy */
    LARGE_TRIANGLE = 32    /* pixels of a box: 168,100 triangles at 2048^2 have some 80, a million some 14 */
};

int32_t skg_raster_choose(const skg_raster_facts *facts, const char **why) {
    if (facts->is_gpu) {
        *why = "a GPU adds integers in global memory without sorting first";
        return SKG_STRATEGY_ATOMICS;
    }
    if (facts->workers > FEW_WORKERS && facts->image_bytes > LARGE_IMAGE / facts->workers) {
        *why = "a private image for each of so many workers costs more than sorting triangles into bands";
        return SKG_STRATEGY_TILES;
    }
    if (facts->image_bytes > LARGE_IMAGE && facts->triangle_pixels >= LARGE_TRIANGLE) {
        *why = "the image is large and its triangles are not small: bands stay in the cache";
        return SKG_STRATEGY_TILES;
    }
    *why = "few workers, a small image or small triangles: a private image each needs no sorting";
    return SKG_STRATEGY_COPIES;
}
