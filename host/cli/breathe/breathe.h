/* The verb breathe. */
#ifndef SKG_CLI_BREATHE_H
#define SKG_CLI_BREATHE_H

#include "common/args.h"

/* Returns an exit status and prints its errors. */
int cli_breathe(const cli_arguments *arguments);

#endif
