/* The radiograph of --fixed. */
#ifndef CLI_LIVE_FIXED_H
#define CLI_LIVE_FIXED_H

#include "live/hub.h"
#include "live/scene.h"

/* Reads it, if the command line names one, as `register` reads it, and hands it to the pages. Returns an exit status and prints the
 * error. */
int live_fixed_read(live_base *base, const live_scene *scene, live_hub *hub);

#endif
