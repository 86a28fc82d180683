/* A setting as a plan and an image, and its time. */
#ifndef SKG_CLI_COST_MEASURE_H
#define SKG_CLI_COST_MEASURE_H

#include "cost/study.h"

/* A plan of a setting. scene NULL: the one that the setting means. */
skg_status cost_plan(cost_study *study, const cost_setting *setting, skg_scene *scene, skg_plan **plan);

/* The image of a setting, [pixels]. point: receives the times of enough runs and what was planned; NULL: one
 * run. */
skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, cost_point *point);

/* Times of enough runs. */
typedef skg_status (*cost_run)(void *user);
skg_status cost_time(const cost_study *study, cost_run run, void *user, cost_point *point);

/* What was planned. */
skg_status cost_report_plan(const skg_plan *plan, cost_point *point);

/* The type of the images of a precision. */
int32_t cost_type(int32_t precision);

/* Converts values of that type to double, in place. */
void cost_widen(int32_t type, int64_t count, double *values);

/* Passes over the scene that one image takes. */
double cost_passes(const cost_setting *setting);

/* The time of one image, in ms, above which a setting is left out. */
double cost_patience_ms(const cost_study *study);

#endif
