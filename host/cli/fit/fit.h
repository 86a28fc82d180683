/* The verb fit. */
#ifndef SKG_CLI_FIT_H
#define SKG_CLI_FIT_H

#include "common/args.h"

int cli_fit(const cli_arguments *arguments);

#endif
