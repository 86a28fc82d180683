/* Checks of a plan's options. Private. */
#ifndef SKG_PLAN_OPTIONS_H
#define SKG_PLAN_OPTIONS_H

#include "device/device.h"

#include <skiagraph/plan.h>

/* Refuses what the options may not be, on this device. */
skg_status skg_plan_options_check(const skg_plan_options *options, const skg_device_info *device);

#endif
