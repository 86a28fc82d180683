/* Requests of pages that take long: the costs of accuracy, and slices. */
#ifndef CLI_LIVE_ASK_H
#define CLI_LIVE_ASK_H

#include "live/hub.h"
#include "live/scene.h"

/* Measures what each dial costs and changes, and tells the pages each result. Ends when something else is asked for. */
void live_measure(const live_base *base, const live_scene *scene, const live_wish *wish, live_hub *hub);

/* Reconstructs a slice of the scene as a wish has it, and tells pages how far that is and what came out. Ends when a newer wish or another
 * slice is asked for. meanwhile: is called after each projection. */
void live_reconstruct(const live_base *base, const live_wish *wish, const skg_live_asked *switches,
                      live_hub *hub, void (*meanwhile)(void *user), void *user);

#endif
