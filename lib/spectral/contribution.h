/* The contribution of a part to a plane. Private. */
#ifndef SKG_CONTRIBUTION_H
#define SKG_CONTRIBUTION_H

#include <stdint.h>

/* A hit adds weight times the path parameter, plus bias in units of the accumulator. The weight is mm per mm of
 * path, or a coefficient of a basis. A count plane has weight 0 and bias 1. */
typedef struct {
    int64_t plane;
    double weight, bias;
} skg_contribution;

#endif
