/* A scan whose projections the ranks of an MPI job take one group after another. */
#ifndef SKG_CLI_SHARED_H
#define SKG_CLI_SHARED_H

#include "scan/state.h"

/* Computes and writes the missing projections together with the other ranks. Returns an exit status that all ranks
 * agree on. */
int shared_run(const cli_arguments *arguments, cli_acquisition *a);

#endif
