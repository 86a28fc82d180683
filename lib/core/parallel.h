/* Work that several threads share. Private.
 *
 * The threads live as long as the call: none is left that spins beside the threads of a driver, or that a fork would lose. */
#ifndef SKG_PARALLEL_H
#define SKG_PARALLEL_H

#include "core/core.h"

/* Does one item. It may be called by several threads at a time, in default arithmetic and the C locale. It must not log. */
typedef skg_status (*skg_item_work)(void *user, int64_t item);

/* Does items 0 <= item < count, which are begun in ascending order, by as many threads as there are CPUs for this one. If
 * items fail, returns the status and sets the message of the first of them; later ones may be left out then. */
skg_status skg_parallel(int64_t count, skg_item_work work, void *user);

#endif
