/* Measuring the settings. */
#ifndef SKG_CLI_COST_SWEEP_H
#define SKG_CLI_COST_SWEEP_H

#include "cost/study.h"

/* Measures the most informative settings, as many as the time allows. */
int cost_sweep(cost_study *study);

#endif
