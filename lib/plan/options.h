/* Checks of a plan's options. Private. */
#ifndef SKG_PLAN_OPTIONS_H
#define SKG_PLAN_OPTIONS_H

#include "device/device.h"

#include <skiagraph/plan.h>

/* Fails if a flag is neither 0 nor 1. name: of the option. */
skg_status skg_check_flag(const char *name, int32_t flag);

/* Fails unless a choice is 0 to last. choices: their names. */
skg_status skg_check_choice(const char *name, int32_t choice, int32_t last, const char *choices);

/* Refuses options of no effect that cannot be used on this device. */
skg_status skg_plan_options_check(const skg_plan_options *options, const skg_device_info *device);

#endif
