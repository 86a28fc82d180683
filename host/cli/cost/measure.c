#include "cost/measure.h"

#include "common/progress.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_RUNS = 200 };

double cost_passes(const cost_setting *setting) {
    return (double)(setting->samples > 0 ? setting->samples : 1) * setting->supersampling *
           setting->supersampling;
}

double cost_patience_ms(const cost_study *study) {
    return study->quick ? 1e3 : 4e3;
}

skg_status cost_plan(cost_study *study, const cost_setting *setting, skg_scene *scene, skg_plan **plan) {
    skg_plan_options options = study->session.options;
    skg_spot spot;
    skg_spectrum *spectrum = NULL;
    skg_status status = cost_spectrum(study, setting->bins, &spectrum);
    if (status != SKG_OK) return status;
    options.precision = setting->precision;
    options.tolerance = setting->tolerance;
    options.supersampling = setting->supersampling;
    if (setting->repair >= 0) options.repair = setting->repair;
    if (!study->noisy) {
        options.noise = 0;
        options.electronic_kev = options.quantum_step_kev = 0;
    }
    options.overlaps = 0; /* cost_open has reported them */
    if (setting->samples > 0) {
        spot = *options.spot;
        spot.samples = setting->samples;
        options.spot = &spot;
    }
    if (!scene) scene = setting->meshing < 0 ? study->session.scene : study->meshings[setting->meshing].scene;
    return skg_plan_create(study->session.context, scene, &study->session.view, spectrum, &options, plan);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Runs until there are enough runs and they took long enough for the clock. */
skg_status cost_time(const cost_study *study, cost_run run, void *user, cost_point *point) {
    const int64_t least = study->quick ? 3 : 9;
    const double wish_ms = study->quick ? 20 : 300, limit_ms = study->quick ? 1000 : 3000;
    double ms[MOST_RUNS], begun = cli_now_ms(), passed = 0;
    int64_t n = 0;
    skg_status status = SKG_OK;
    while (n < MOST_RUNS && (n < least || passed < wish_ms) && (n < 2 || passed < limit_ms)) {
        double start = cli_now_ms();
        status = run(user);
        if (status < SKG_OK) return status;
        ms[n++] = cli_now_ms() - start;
        passed = cli_now_ms() - begun;
    }
    qsort(ms, (size_t)n, sizeof *ms, ascending);
    point->runs = n;
    point->min_ms = ms[0];
    point->median_ms = 0.5 * (ms[(n - 1) / 2] + ms[n / 2]);
    return status;
}

skg_status cost_report_plan(const skg_plan *plan, cost_point *point) {
    skg_plan_report report;
    skg_plan_report_init(&report);
    skg_status status = skg_plan_report_get(plan, &report);
    point->nodes = report.nodes;
    point->planes = report.planes;
    point->bins = report.bins;
    return status;
}

int32_t cost_type(int32_t precision) {
    return precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
}

void cost_widen(int32_t type, int64_t count, double *values) {
    for (int64_t i = count - 1; type == SKG_TYPE_FLOAT32 && i >= 0; i--) {
        float value;
        memcpy(&value, (const char *)values + (size_t)i * sizeof value, sizeof value);
        values[i] = (double)value;
    }
}

typedef struct {
    skg_plan *plan;
    skg_output output;
} still;

static skg_status make_still(void *user) {
    still *its = user;
    return skg_plan_image(its->plan, &its->output);
}

skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, cost_point *point) {
    still its = {0};
    double start = cli_now_ms();
    skg_status status = cost_plan(study, setting, NULL, &its.plan);
    if (status < SKG_OK) return status;
    if (point) point->plan_ms = cli_now_ms() - start;
    skg_output_init(&its.output);
    its.output.type = cost_type(setting->precision);
    its.output.data = image;
    status = make_still(&its);
    if (status >= SKG_OK && point) status = cost_time(study, make_still, &its, point);
    if (status >= SKG_OK && point) status = cost_report_plan(its.plan, point);
    if (status >= SKG_OK) cost_widen(its.output.type, study->pixels, image);
    skg_plan_release(&its.plan);
    return status < SKG_OK ? status : SKG_OK;
}
