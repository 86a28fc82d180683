/* The verb `view`. */
#ifndef SKG_CLI_VIEW_H
#define SKG_CLI_VIEW_H

#include "common/args.h"

/* Returns an exit status and prints its errors. */
int cli_view(const cli_arguments *arguments);

#endif
