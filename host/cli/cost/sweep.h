/* Which settings are measured, and measuring them. */
#ifndef SKG_CLI_COST_SWEEP_H
#define SKG_CLI_COST_SWEEP_H

#include "cost/study.h"

/* Measures every setting. */
int cost_sweep(cost_study *study);

#endif
