/* Whether a device computes rightly: found out once for each device, driver and version of the kernels, and kept. Private. */
#ifndef SKG_TRIAL_H
#define SKG_TRIAL_H

#include "selftest/judge.h"

/* Makes sure that the device has passed a test: in this context, or in an earlier process, or else now. SKG_ERR_DEVICE
 * with a sentence that names the kernels, the device and its driver if it has failed it. */
skg_status skg_trial_need(skg_context *context, skg_trial_number number);

/* Runs a test. The status is that of the calls, which fail if the device cannot run it at all. */
skg_status skg_trial_run(skg_context *context, skg_trial_number number, skg_finding *finding);

/* Runs a test, whatever was found before, and keeps what is found. */
skg_status skg_trial_again(skg_context *context, skg_trial_number number, skg_finding *finding);

#endif
