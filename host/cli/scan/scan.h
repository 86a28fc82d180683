/* The verb scan. */
#ifndef SKG_CLI_SCAN_H
#define SKG_CLI_SCAN_H

#include "common/args.h"

/* Returns an exit status and prints its errors. */
int cli_scan(const cli_arguments *arguments);

#endif
