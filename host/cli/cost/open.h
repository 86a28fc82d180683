/* What the scene is like, and which dials it has. */
#ifndef SKG_CLI_COST_OPEN_H
#define SKG_CLI_COST_OPEN_H

#include "cost/study.h"

/* Reads what the dials can be, and the scene's own setting. Close the study also after a failure. */
int cost_open(cost_study *study);
void cost_close(cost_study *study);

#endif
