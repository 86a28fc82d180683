/* The parts of a scene that --only and --without leave. */
#ifndef SKG_CLI_CHOSEN_H
#define SKG_CLI_CHOSEN_H

#include "session/session.h"

/* Replaces the scene of a session by one of the parts that the flags leave. View and beam stay. Returns an exit status. */
int cli_choose_parts(const cli_arguments *arguments, cli_session *session);

/* Sets chosen[p] to 1 for each of `count` parts whose label fits one of the patterns of a flag's value, which have commas between them.
 * Returns an exit status: CLI_USAGE where a pattern fits none. */
int cli_mark_parts(const skg_scene *scene, const char *flag, const char *text, int64_t count, char *chosen);

#endif
