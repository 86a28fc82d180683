/* From the flags of `scan` to a finished output. These functions return an exit status and print the error. */
#ifndef SKG_CLI_ACQUISITION_H
#define SKG_CLI_ACQUISITION_H

#include "scan/state.h"

int acquisition_read_flags(const cli_arguments *arguments, cli_acquisition *a);

/* Opens the session, makes plan and motion, and opens the output. */
int acquisition_open(const cli_arguments *arguments, cli_acquisition *a);

/* Computes and writes what is missing. */
int acquisition_run(const cli_arguments *arguments, cli_acquisition *a);

void acquisition_close(cli_acquisition *a);

#endif
