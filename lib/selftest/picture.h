/* The 3D view of two boxes of which one hides the other. Private. */
#ifndef SKG_TRIAL_PICTURE_H
#define SKG_TRIAL_PICTURE_H

#include "selftest/judge.h"

/* Whether each box is where it has to be, in its own colour. The status is that of the calls. */
skg_status skg_picture_judge(skg_context *context, skg_finding *finding);

#endif
