/* A scene that breathes, with another relaxation or hysteresis. */
#ifndef SKG_CLI_COST_PHASES_H
#define SKG_CLI_COST_PHASES_H

#include "cost/study.h"

/* Poses and images of a setting at the phases of a breath. point NULL: they become the reference; otherwise
 * they are compared with it. *exit_status: of errors that were printed here. */
skg_status cost_breathe(cost_study *study, const cost_setting *setting, cost_point *point, int *exit_status);

#endif
