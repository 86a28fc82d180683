/* Computing and writing a run. */
#ifndef SKG_CLI_BATCHES_H
#define SKG_CLI_BATCHES_H

#include "scan/state.h"

/* Computes and writes a run, batch after batch. */
skg_status write_batches(cli_acquisition *a, skg_scan_run *run, int shows_progress);

#endif
