/* Settings that change several dials. */
#ifndef SKG_CLI_COST_COMBINE_H
#define SKG_CLI_COST_COMBINE_H

#include "cost/study.h"

/* Predicts error and time of all combinations of the measured values of the dials, and measures those that look best, as long as
 * the share of the given time allows. image: [pixels], to work with. */
int cost_combine(cost_study *study, double share, double *image);

/* Marks the shots than which no other is both faster and nearer to the reference COST_OF_ALL. */
void cost_find_frontier(cost_study *study);

#endif
