/* A setting as a plan, an image, and times. */
#ifndef SKG_CLI_COST_MEASURE_H
#define SKG_CLI_COST_MEASURE_H

#include "cost/study.h"

/* A plan of a setting. scene NULL: the one that the setting means. */
skg_status cost_plan(cost_study *study, const cost_setting *setting, skg_scene *scene, skg_plan **plan);

/* The image of a setting, [pixels], without timing it. ms: the time of the run, may be NULL. */
skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, double *ms);

/* The image of a setting, [pixels], and the shot of that setting. A setting that is new is timed. */
skg_status cost_shoot(cost_study *study, const cost_setting *setting, double *image, int *number);

/* Finds a shot; negative: the setting was not measured. */
int cost_find_shot(const cost_study *study, const cost_setting *setting);

/* Adds a shot without times; negative: there are too many. */
int cost_add_shot(cost_study *study, const cost_setting *setting);

/* Adds the times of a visit to a shot: of at least `least` runs, and more until they took `wish_ms`. */
typedef skg_status (*cost_run)(void *user);
skg_status cost_time(cost_study *study, cost_run run, void *user, int64_t least, double wish_ms,
                     cost_shot *shot);

/* Runs and milliseconds of a first visit. */
int64_t cost_first_runs(const cost_study *study);
double cost_first_ms(const cost_study *study);

/* Visits every still shot again, as long as the share of the given time allows: the wanted ones first. */
skg_status cost_visit_again(cost_study *study, double share);

/* What was planned. */
skg_status cost_report_plan(const skg_plan *plan, cost_shot *shot);

/* The type of the images of a precision. */
int32_t cost_type(int32_t precision);

/* Converts values of that type to double, in place. */
void cost_widen(int32_t type, int64_t count, double *values);

/* Passes over the scene that one image takes. */
double cost_passes(const cost_setting *setting);

/* The time of one image, in ms, above which a setting is left out. */
double cost_patience_ms(const cost_study *study);

/* Estimates the time of one image, and of measuring a setting for the first time, from those of the scene's own. */
double cost_estimate_ms(const cost_study *study, const cost_setting *setting);
double cost_effort_ms(const cost_study *study, const cost_setting *setting);

#endif
