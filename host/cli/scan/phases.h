/* A scan of a breathing scene, sorted into phases of the breath. */
#ifndef SKG_CLI_SCAN_PHASES_H
#define SKG_CLI_SCAN_PHASES_H

#include "scan/state.h"

/* Reads --phases N. These functions return an exit status and print the error. */
int phases_read_flag(const cli_arguments *arguments, cli_acquisition *a);

/* Writes a file for each phase beside the finished output: scan.phase-1-of-8.h5 for scan.h5. */
int phases_write(cli_acquisition *a);

#endif
