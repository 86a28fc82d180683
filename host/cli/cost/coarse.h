/* Every source of error, measured coarsely and without times before anything is measured finely. */
#ifndef SKG_CLI_COST_COARSE_H
#define SKG_CLI_COST_COARSE_H

#include "cost/study.h"

/* Compares the scene with a setting in which one dial is better, for every source that can be measured, as long as time is left.
 * A source that was not measured has the reason. own: the scene's image. */
int cost_measure_coarsely(cost_study *study, double *own);

#endif
