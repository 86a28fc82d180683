/* Positions of a plan's part in memory of the device. Private. */
#ifndef SKG_TRIAL_PLACE_H
#define SKG_TRIAL_PLACE_H

#include "device/device.h"
#include "selftest/scene.h"

#include <skiagraph/plan.h>

/* Moves the part to where its boxes have to be, by positions of which some lie beyond the bounds that they are put on. The
 * buffer has to stay while frames run. */
skg_status skg_trial_place(skg_context *context, const skg_trial_scene *scene, skg_plan *plan,
                           skg_buffer *buffer);

#endif
