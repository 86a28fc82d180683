/* Accumulators that parts with proportional contributions share. Private.
 *
 * A part inside another adds to two or more planes: with a positive weight to that of its own material, and with
 * a negative one to that of its parent. Parts whose lists of contributions are proportional (all bones in fat,
 * all vessels in a liver) may add to one accumulator, each with its factor. The list of the accumulator is then
 * applied once for each pixel, not for each hit; a hit is one addition, and its kernel needs no lists. */
#ifndef SKG_MIX_H
#define SKG_MIX_H

#include "core/core.h"
#include "spectral/contribution.h"

typedef struct {
    int32_t sums; /* number of accumulators; 0: parts add to planes by their lists */
    int32_t reserved;
    double *lists;                   /* [sums][planes] what a unit of an accumulator adds to the planes */
    skg_contribution *contributions; /* at most one for each part, to an accumulator */
    int64_t *first_contribution;     /* [parts + 1] */
} skg_mix;

/* Finds the accumulators of these lists. mix->sums is 0 if more than `most` were needed. */
skg_status skg_mix_find(int64_t parts, int32_t planes, const skg_contribution *contributions,
                        const int64_t *first_contribution, int32_t most, skg_mix *mix);
void skg_mix_release(skg_mix *mix);

/* The number of accumulators that these lists need; 0 if it is more than `most`, or if no part adds to more than one plane. */
skg_status skg_mix_choose(int64_t parts, int32_t planes, const skg_contribution *contributions,
                          const int64_t *first_contribution, int32_t most, int32_t *sums);

#endif
