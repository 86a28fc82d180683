/* Surfaces that add alike share an accumulator. Private.
 *
 * A part inside another adds to two planes or more: its own matter's, and, negative, that of its parent.
 * Parts whose lists are proportional (all bones in fat, all vessels in a liver) can as well add to one
 * accumulator, each with its factor; what the accumulator's list says is done once a pixel, not once a hit.
 * A hit is then one addition, and its kernel knows no lists. */
#ifndef SKG_MIX_H
#define SKG_MIX_H

#include "core/core.h"
#include "spectral/contribution.h"

typedef struct {
    int32_t sums; /* accumulators; 0: parts add to planes as their lists say */
    int32_t reserved;
    double *lists;                   /* [sums][planes] what a unit of an accumulator adds to the planes */
    skg_contribution *contributions; /* at most one a part, to an accumulator */
    int64_t *first_contribution;     /* [parts + 1] */
} skg_mix;

/* The accumulators of these lists; mix->sums is 0 where there are more than `most`. */
skg_status skg_mix_find(int64_t parts, int32_t planes, const skg_contribution *contributions,
                        const int64_t *first_contribution, int32_t most, skg_mix *mix);
void skg_mix_release(skg_mix *mix);

/* How many accumulators pay for these planes: each is zeroed and read pixel by pixel, so no more than half as
 * many again. 0: no part adds to more than one plane. Measured with the generated thorax (42,000 triangles,
 * 512 x 512, 5 materials). */
skg_status skg_mix_choose(int64_t parts, int32_t planes, const skg_contribution *contributions,
                          const int64_t *first_contribution, int32_t *sums);

#endif
