/* Man pages and completion of shells, from the tables of the manual. */
#ifndef SKG_CLI_PAGES_H
#define SKG_CLI_PAGES_H

#include "manual/manual.h"

#include <stdio.h>

/* skiagraph.1, and skiagraph-VERB.1. version: "0.1.0" */
void pages_man_command(const char *version, FILE *stream);
void pages_man_verb(const cli_manual *manual, const char *version, FILE *stream);

void pages_bash(FILE *stream);
void pages_zsh(FILE *stream);

#endif
