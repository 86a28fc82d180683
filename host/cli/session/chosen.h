/* The parts of a scene that --only and --without leave. */
#ifndef SKG_CLI_CHOSEN_H
#define SKG_CLI_CHOSEN_H

#include "session/session.h"

/* Replaces the scene of a session by one of the parts that the flags leave. View and beam stay. Returns an exit status. */
int cli_choose_parts(const cli_arguments *arguments, cli_session *session);

#endif
