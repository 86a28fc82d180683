/* The verbs scan and reconstruct. */
#ifndef SKG_CLI_SCAN_H
#define SKG_CLI_SCAN_H

#include "common/args.h"

#include <skiagraph/skiagraph.h>

/* They return an exit status and print their errors. */
int cli_scan(const cli_arguments *arguments);
int cli_reconstruct(const cli_arguments *arguments);

#endif
