/* Checksums of a scan. These functions return an exit status and print the error. */
#ifndef SKG_CLI_VERIFY_H
#define SKG_CLI_VERIFY_H

#include "scan/state.h"

/* Refuses, before anything is laid out, --verify of an output that is not there. samples: of its scan; 0: there is none. */
int verify_check(const cli_arguments *arguments, const cli_acquisition *a, int64_t samples);

/* Notes how many projections were found damaged when the output was opened. */
void verify_note(const cli_acquisition *a);

/* Reads the output and prints what is damaged or missing: exit status 1. Computes nothing. */
int verify_run(const cli_arguments *arguments, cli_acquisition *a);

#endif
