/* What a part's hits add to one plane. Private. */
#ifndef SKG_CONTRIBUTION_H
#define SKG_CONTRIBUTION_H

#include <stdint.h>

/* weight (per mm of path: mm per mm, or a basis coefficient) times the path parameter, plus bias in units of
 * the accumulator (1 with weight 0: a count plane). */
typedef struct {
    int64_t plane;
    double weight, bias;
} skg_contribution;

#endif
