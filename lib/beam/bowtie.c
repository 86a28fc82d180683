/* Bow-tie filters. */
#include "beam/bowtie.h"

#include <inttypes.h>
#include <math.h>

void skg_bowtie_init_sized(void *bowtie, int32_t size) {
    const skg_bowtie defaults = {0};
    skg_struct_init(bowtie, size, &defaults, sizeof defaults);
}

enum { ROWS_MAX = 4096 };

skg_status skg_bowtie_check(const skg_bowtie *bowtie) {
    if (!bowtie->material)
        return skg_fail(SKG_ERR_SCENE, "the bow-tie has no material; give one of known density");
    if (bowtie->count < 2 || bowtie->count > ROWS_MAX || !bowtie->angle_deg || !bowtie->path_mm)
        return skg_fail(SKG_ERR_SCENE,
                        "the bow-tie's profile has %" PRId64 " rows; give 2 to %d angles with their paths",
                        bowtie->count, ROWS_MAX);
    for (int64_t k = 0; k < bowtie->count; k++) {
        const double angle = bowtie->angle_deg[k], path = bowtie->path_mm[k];
        if (!(fabs(angle) <= 89) || (k > 0 && !(angle > bowtie->angle_deg[k - 1])))
            return skg_fail(SKG_ERR_SCENE,
                            "row %" PRId64
                            " of the bow-tie's profile has %g degrees; angles rise from -89 to 89",
                            k + 1, angle);
        if (!(path >= 0 && isfinite(path)))
            return skg_fail(SKG_ERR_SCENE,
                            "row %" PRId64 " of the bow-tie's profile has a path of %g mm; 0 or more", k + 1,
                            path);
    }
    return SKG_OK;
}
