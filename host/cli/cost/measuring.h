/* Measuring settings: times, images, and their errors against a reference. */
#ifndef CLI_COST_MEASURING_H
#define CLI_COST_MEASURING_H

#include "cost/study.h"

/* A setting as a plan, an image, and times. */

/* A plan of a setting. scene NULL: the one that the setting means. */
skg_status cost_plan(cost_study *study, const cost_setting *setting, skg_scene *scene, skg_plan **plan);

/* The image of a setting, [pixels], without timing it. ms: the time of the run, may be NULL. */
skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, double *ms);

/* The image of a setting, [pixels], and the shot of that setting. A setting that is new is timed. */
skg_status cost_shoot(cost_study *study, const cost_setting *setting, double *image, int *number);

/* The image, [pixels], of the scene's own setting with another scene, and its price in a shot. batch: [frames][pixels], to work with */
skg_status cost_shoot_scene(cost_study *study, skg_scene *scene, double *batch, double *image,
                            cost_shot *shot);

/* Finds a shot; negative: the setting was not measured. */
int cost_find_shot(const cost_study *study, const cost_setting *setting);

/* Adds the times of a visit to a shot: of at least `least` runs, and more until they took `wish_ms`. */
typedef skg_status (*cost_run)(void *user);
skg_status cost_time(cost_study *study, cost_run run, void *user, int64_t least, double wish_ms,
                     cost_shot *shot);

/* Adds a shot to the study: one that has begun with its setting, frames and time of planning, the times of its first visit and the decisions
 * of its plan. SKG_ERR_MEMORY: there are too many. */
skg_status cost_add_shot(cost_study *study, const skg_plan *plan, cost_run run, void *user,
                         const cost_shot *begun, int *number);

/* Sorts values, rising. */
void cost_sort(int64_t count, double *values);

/* Runs and milliseconds of a first visit. */
int64_t cost_first_runs(const cost_study *study);
double cost_first_ms(const cost_study *study);

/* Visits every still shot again, as long as the share of the given time allows: the wanted ones first. */
skg_status cost_visit_again(cost_study *study, double share);

/* The type of the images of a precision. */
int32_t cost_type(int32_t precision);

/* Converts values of that type to double, in place. */
void cost_widen(int32_t type, int64_t count, double *values);

/* Passes over the scene that one image takes. */
double cost_passes(const cost_setting *setting);

/* The time of one image, in ms, above which a setting is left out. It is a share of the given time, up to a limit. */
enum { COST_PATIENCE_MAX_MS = 4000 };
double cost_patience_ms(const cost_study *study);

/* Estimates the time of one image, and of measuring a setting for the first time, from those of the scene's own. */
double cost_estimate_ms(const cost_study *study, const cost_setting *setting);
double cost_effort_ms(const cost_study *study, const cost_setting *setting);

/* Errors of images and of path lengths. */

/* Errors of `images` images against those of a reference, and a small picture of the difference. */
int cost_compare(const cost_study *study, int64_t images, const double *image, const double *reference,
                 cost_point *point);

/* Error of an image against a better one, as that of a source. */
int cost_compare_coarsely(const cost_study *study, const double *image, const double *better,
                          cost_coarse *coarse);

/* Errors of a shot's image against the reference COST_OF_ALL, and small pictures of both, unless it has them. */
int cost_compare_shot(const cost_study *study, const double *image, cost_shot *shot);

/* Errors in mm of the path lengths of all parts, against a setting in the best precision that there is. */
void cost_compare_lengths(cost_study *study, const cost_setting *reference, cost_point *point);

/* Scatter, which the images of all settings lack. */

/* Predicts it. plan: of the scene */
void cost_predict_scatter(cost_study *study, skg_plan *plan);

/* Measures what it costs, as far as a share of the given time allows, and what images lack without it. */
int cost_measure_scatter(cost_study *study);

/* Fills in study->measured.between where the scene has volumes. */
int cost_measure_between(cost_study *study);

/* Fills in study->measured.sensitivity if study->sensitive is 1. */
int cost_measure_sensitivity(cost_study *study);

/* Points: settings, each compared with a reference. */

/* Computes the image of a reference, whose setting is in the study. */
int cost_make_reference(cost_study *study, int number);

/* Measures a point, and those that are planned with the same setting and a reference that is made. A setting that cannot be
 * computed is noted and left out. image: [pixels], to work with. */
int cost_measure(cost_study *study, cost_point *point, double *image);

/* Measures every source of error coarsely and without times, before anything is measured finely: compares the scene with a
 * setting in which one dial is better, for every source that can be measured, as long as time is left. A source that was not
 * measured has the reason. own: the scene's image. */
int cost_measure_coarsely(cost_study *study, double *own);

/* Measures the most informative settings, as many as the time allows. */
int cost_sweep(cost_study *study);

/* Settings that change several dials. */

/* Predicts error and time of all combinations of the measured values of the dials, and measures those that look best, as long as
 * the share of the given time allows. image: [pixels], to work with. */
int cost_combine(cost_study *study, double share, double *image);

/* Marks the shots than which no other is both faster and nearer to the reference COST_OF_ALL. */
void cost_find_frontier(cost_study *study);

/* A scene that breathes, with another relaxation or hysteresis. */

/* Poses and images of a setting at the phases of a breath. point NULL: they become the reference; otherwise
 * they are compared with it. *exit_status: of errors that were printed here. */
skg_status cost_breathe(cost_study *study, const cost_setting *setting, cost_point *point, int *exit_status);

#endif
