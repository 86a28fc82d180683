/* Stage `repair`: what the bad pixels of leaky parts get. Private.
 *
 * Values are added to the shared sums as integers, so that every strategy leaves the same bits. */
#ifndef SKG_REPAIR_H
#define SKG_REPAIR_H

#include "stage/leaky_batch.h"

/* Enqueues the repair of a batch behind its verdicts and its sums. repair: SKG_REPAIR_...; EXACT waits for the raster. */
skg_status skg_repair_run(const skg_leaky_batch *batch, int32_t repair);

#endif
