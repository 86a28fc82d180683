/* A registration that a page has asked for, on a thread of its own. */
#ifndef CLI_LIVE_REGISTERING_H
#define CLI_LIVE_REGISTERING_H

#include "live/hub.h"
#include "live/scene.h"

typedef struct live_registering live_registering;

/* Begins to register a part, from where the wish has it, to the radiograph of the base, and tells pages how far it is and what it
 * has found. Returns 0 with a sentence. */
int live_registering_begin(const live_base *base, const live_wish *wish, int64_t part, live_hub *hub,
                           live_registering **registering, char *sentence);

/* Ends the search after the step that is under way; the best pose so far is told. */
void live_registering_stop(live_registering *registering);

/* Whether nothing is left but to tell what was found. NULL: no. */
int live_registering_is_over(live_registering *registering);

/* Stops it, waits until it is over, and frees it. NULL: does nothing. */
void live_registering_end(live_registering **registering);

#endif
