/* `devices --warm`. */
#ifndef SKG_CLI_WARM_H
#define SKG_CLI_WARM_H

#include "common/args.h"

/* Renders every scene of --warm once. Returns an exit status, of the first scene that failed. */
int cli_warm(const cli_arguments *arguments);

#endif
