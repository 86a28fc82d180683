/* Reports the decisions of a plan as text and as JSON. */
#ifndef SKG_CLI_EXPLAIN_H
#define SKG_CLI_EXPLAIN_H

#include "session/prediction.h"
#include "session/session.h"

#include <jansson.h>

/* Creates the session's plan and measures the time. The caller releases the plan. Returns an exit status and
 * prints the error. */
int cli_make_plan(const cli_session *session, skg_plan **plan, double *plan_ms);

/* The object that `plan --json` prints, and other verbs under the key "plan". */
json_t *cli_explain_json(const skg_plan *plan, const cli_session *session);
void cli_explain_print(const skg_plan *plan, const cli_session *session, const cli_prediction *prediction);

#endif
