/* A finished .h5 again, compressed. These functions return an exit status and print the error. */
#ifndef SKG_CLI_PACKED_H
#define SKG_CLI_PACKED_H

#include "scan/state.h"

int packed_read_flags(const cli_arguments *arguments, cli_acquisition *a);

/* Writes the file of --packed if the scan is finished. */
int packed_write(const cli_arguments *arguments, const cli_acquisition *a);

#endif
