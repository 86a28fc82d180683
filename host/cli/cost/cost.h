/* The verb cost. */
#ifndef SKG_CLI_COST_H
#define SKG_CLI_COST_H

#include "common/args.h"

/* Returns an exit status and prints its errors. */
int cli_cost(const cli_arguments *arguments);

#endif
