/* Runs one of the small scenes and compares what comes out with what has to. Private. */
#ifndef SKG_JUDGE_H
#define SKG_JUDGE_H

#include "selftest/finding.h"
#include "selftest/scene.h"

/* The status is that of the calls, which fail if the device cannot run the scene at all. */
skg_status skg_trial_judge(skg_context *context, skg_trial_number number, skg_finding *finding);

#endif
