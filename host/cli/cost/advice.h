/* Which setting to use. */
#ifndef SKG_CLI_COST_ADVICE_H
#define SKG_CLI_COST_ADVICE_H

#include "cost/study.h"

/* Marks the frontier and fills study->advice; measures the combinations that were not measured yet. */
int cost_advise(cost_study *study);

#endif
