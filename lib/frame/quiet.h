/* For callers who know that nothing falls on the detector. Private. */
#ifndef SKG_QUIET_H
#define SKG_QUIET_H

#include <skiagraph/types.h>

/* Sets whether the plan has already warned that nothing falls on the detector, and returns whether it had. */
int32_t skg_plan_warned_unseen_set(skg_plan *plan, int32_t warned);

#endif
