/* What a device test has found. Private. */
#ifndef SKG_TRIAL_FINDING_H
#define SKG_TRIAL_FINDING_H

#include <stdint.h>

typedef struct {
    int32_t good; /* 1: every pixel is what it has to be */
    int32_t reserved;
    double score;     /* SKG_TRIAL_CORE: images of 512 x 512 pixels per second; otherwise 0 */
    char reason[256]; /* what is wrong, with the first pixel; "" if it is good */
} skg_finding;

#endif
