/* Errors of images and of path lengths. */
#ifndef SKG_CLI_COST_COMPARE_H
#define SKG_CLI_COST_COMPARE_H

#include "cost/study.h"

/* Errors of `images` images against those of a reference, and a small picture of the difference. */
int cost_compare(const cost_study *study, int64_t images, const double *image, const double *reference,
                 cost_point *point);

/* Errors of a shot's image against the reference COST_OF_ALL, and small pictures of both, unless it has them. */
int cost_compare_shot(const cost_study *study, const double *image, cost_shot *shot);

/* Errors in mm of the path lengths of all parts, against a setting in the best precision that there is. */
void cost_compare_lengths(cost_study *study, const cost_setting *reference, cost_point *point);

#endif
