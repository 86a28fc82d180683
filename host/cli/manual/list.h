/* Every verb, and what is known of the command as a whole. */
#ifndef SKG_CLI_LIST_H
#define SKG_CLI_LIST_H

#include "manual/manual.h"

/* Every verb, in the order of `skiagraph help`; ends with NULL. */
extern const cli_manual *const cli_manuals[];

extern const char cli_summary[];           /* of the command, one sentence */
extern const char *const cli_text[];       /* of the command, paragraphs; ends with NULL */
extern const cli_item cli_other_verbs[];   /* help and version, which are no rows of cli_manuals */
extern const cli_item cli_exit_statuses[]; /* of every verb */
extern const cli_item cli_environment[];   /* variables that the command or its platform reads */

#endif
