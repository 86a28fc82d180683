/* Runs one of the small scenes and compares what comes out with what has to. Private. */
#ifndef SKG_JUDGE_H
#define SKG_JUDGE_H

#include "trial/scene.h"

typedef struct {
    int32_t good; /* 1: every pixel is what it has to be */
    int32_t reserved;
    double score;     /* SKG_TRIAL_CORE: images of 512 x 512 pixels per second; otherwise 0 */
    char reason[256]; /* what is wrong, with the first pixel; "" if it is good */
} skg_finding;

/* The status is that of the calls, which fail if the device cannot run the scene at all. */
skg_status skg_trial_judge(skg_context *context, skg_trial_number number, skg_finding *finding);

#endif
