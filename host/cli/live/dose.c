/* Dose of a frame of a page, from the library's dose of the plan without photons that are followed. */
#include "live/dose.h"

#include "common/encode.h"
#include "common/interrupt.h"

#include <math.h>
#include <string.h>

int live_dose_is_known(const live_scene *scene, double phase) {
    return scene->dose && memcmp(&scene->dose_view, &scene->view, sizeof scene->view) == 0 &&
           (scene->dose_phase == phase || (isnan(scene->dose_phase) && isnan(phase)));
}

static json_t *figures(const skg_dose *dose) {
    skg_dose_report report;
    skg_dose_point point;
    skg_dose_report_init(&report);
    skg_dose_point_init(&point);
    if (skg_dose_report_get(dose, &report) != SKG_OK || skg_dose_point_get(dose, 0, &point) != SKG_OK)
        return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "at", cli_json_numbers(point.at, 3));
    json_object_set_new(object, "air_kerma_uGy", cli_json_number(point.air_kerma_ugy));
    json_object_set_new(object, "kap_uGy_cm2", cli_json_number(report.kap_ugy_cm2));
    json_object_set_new(object, "detector_air_kerma_uGy", cli_json_number(report.detector_air_kerma_ugy));
    json_object_set_new(object, "exposure_index", cli_json_number(report.exposure_index));
    return object;
}

/* A newer wish and the end are not kept waiting. */
static int32_t is_enough(int64_t done, int64_t total, void *user) {
    (void)done, (void)total;
    return live_hub_has(user, SKG_LIVE_ASKED_WISH) || cli_stop_asked();
}

int live_dose_find(live_scene *scene, live_hub *hub, double phase) {
    skg_dose_options options;
    skg_dose *dose = NULL;
    skg_plan *plan = NULL;
    skg_status status = SKG_OK;
    skg_dose_options_init(&options);
    options.histories = 0;
    json_decref(scene->dose);
    scene->dose = NULL;
    scene->dose_view = scene->view, scene->dose_phase = phase;
    status = skg_progress_create(is_enough, hub, &options.progress);
    if (status == SKG_OK) status = skg_live_plans_whole_get(scene->plans, &plan);
    if (status == SKG_OK) status = skg_plan_view_set(plan, &scene->view);
    if (status == SKG_OK) status = skg_dose_create(plan, &options, &dose);
    if (status == SKG_OK) scene->dose = figures(dose);
    skg_dose_release(&dose);
    skg_progress_release(&options.progress);
    if (plan) (void)skg_plan_view_set(plan, &scene->session.view); /* which the plan was made with */
    if (!scene->dose && status != SKG_ERR_CANCELLED) scene->dose = json_null();
    return scene->dose != NULL;
}
