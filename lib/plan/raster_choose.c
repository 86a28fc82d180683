#include "plan/raster.h"

#include <skiagraph/plan.h>

enum {
    FEW_WORKERS = 4,
    COPIES_BYTES = 8 << 20, /* of one private copy: zeroed and read once per worker and frame */
};

int32_t skg_raster_choose(const skg_raster_facts *facts, const char **why) {
    if (facts->is_gpu) {
        *why = "a GPU adds integers in global memory as fast as it draws small triangles";
        return SKG_STRATEGY_ATOMICS;
    }
    if (facts->workers > FEW_WORKERS && facts->image_bytes > COPIES_BYTES / facts->workers) {
        *why = "private copies for so many workers would cost more than binning";
        return SKG_STRATEGY_TILES;
    }
    if (facts->image_bytes > COPIES_BYTES) {
        *why = "private copies of so large an image leave every cache";
        return SKG_STRATEGY_TILES;
    }
    *why = "few workers and a small image: private copies need no binning";
    return SKG_STRATEGY_COPIES;
}
