/* Points: settings, each compared with a reference. */
#ifndef SKG_CLI_COST_POINTS_H
#define SKG_CLI_COST_POINTS_H

#include "cost/study.h"

/* Computes the image of a reference, whose setting is in the study. */
int cost_make_reference(cost_study *study, int number);

/* Measures a point, and those that are planned with the same setting and a reference that is made. A setting that cannot be
 * computed is noted and left out. image: [pixels], to work with. */
int cost_measure(cost_study *study, cost_point *point, double *image);

#endif
