/* Computing and writing a run. */
#ifndef SKG_CLI_BATCHES_H
#define SKG_CLI_BATCHES_H

#include "scan/state.h"

/* Computes and writes the next batch of a run. count: its projections; 0: the run is finished */
skg_status write_batch(cli_acquisition *a, skg_scan_run *run, int64_t *count);

/* Computes and writes a run, batch after batch. */
skg_status write_batches(cli_acquisition *a, skg_scan_run *run);

#endif
