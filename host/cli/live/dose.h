/* Dose of a frame of a page: air kerma, kerma-area product, exposure index. */
#ifndef CLI_LIVE_DOSE_H
#define CLI_LIVE_DOSE_H

#include "live/hub.h"
#include "live/scene.h"

/* Whether the figures of the scene are those of what is shown and of a phase of the breath. */
int live_dose_is_known(const live_scene *scene, double phase);

/* Finds the figures without following photons, into scene->dose: an object, or null where the number of photons is not known or the scene has
 * no such figures. Returns 0, and they stay unknown, if a newer wish or the end comes first. */
int live_dose_find(live_scene *scene, live_hub *hub, double phase);

#endif
