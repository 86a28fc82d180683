/* The help texts on a terminal. */
#ifndef SKG_CLI_HELP_H
#define SKG_CLI_HELP_H

#include "manual/manual.h"

#include <stdio.h>

void cli_help_overview(FILE *stream);
void cli_help_verb(const cli_manual *manual, FILE *stream);

#endif
