/* Times a point, with the patience that its frames need. */
#include "cost/measuring.h"

#include "common/progress.h"
#include "cost/clock.h"
#include "cost/dials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int64_t KEPT_BYTES = (int64_t)1 << 29; /* of all plans that wait for further visits */

double cost_passes(const cost_setting *setting) {
    return (double)(setting->samples > 0 ? setting->samples : 1) * setting->supersampling *
           setting->supersampling;
}

double cost_patience_ms(const cost_study *study) {
    return fmin(study->within_ms / 40, COST_PATIENCE_MAX_MS);
}

double cost_estimate_ms(const cost_study *study, const cost_setting *setting) {
    const double ratio = (double)cost_triangles(study, setting) /
                         (double)(study->subject.triangles ? study->subject.triangles : 1);
    const double pass = setting->precision == SKG_PRECISION_SINGLE
                            ? study->measured.pass_ms
                            : fmax(study->measured.pass_ms, study->measured.best_pass_ms);
    return pass * cost_passes(setting) * fmax(ratio, 1);
}

double cost_effort_ms(const cost_study *study, const cost_setting *setting) {
    const double image = cost_estimate_ms(study, setting);
    const double runs = image * (double)(cost_first_runs(study) * study->frames);
    return study->measured.plan_ms + image + fmax(runs, cost_first_ms(study));
}

int64_t cost_first_runs(const cost_study *study) {
    return study->quick ? 3 : 4;
}

double cost_first_ms(const cost_study *study) {
    return study->quick ? 20 : 80;
}

skg_status cost_plan(cost_study *study, const cost_setting *setting, skg_scene *scene, skg_plan **plan) {
    skg_plan_options options = study->session.options;
    skg_spot spot;
    skg_spectrum *spectrum = NULL;
    skg_status status = cost_spectrum(study, setting->bins, &spectrum);
    if (status == SKG_OK && !scene) status = cost_scene_of(study, setting, &scene);
    if (status != SKG_OK) return status;
    options.precision = setting->precision;
    options.tolerance = setting->tolerance;
    options.supersampling = setting->supersampling;
    if (setting->repair >= 0) {
        options.repair = setting->repair % COST_UNITE;
        options.unite = setting->repair >= COST_UNITE;
    }
    if (!study->subject.noisy) {
        options.noise = 0;
        options.electronic_kev = options.quantum_step_kev = 0;
    }
    options.overlaps = 0; /* cost_open has reported them */
    if (setting->samples > 0) {
        spot = *options.spot;
        spot.samples = setting->samples;
        options.spot = &spot;
    }
    return skg_plan_create(study->session.context, scene, &study->session.view, spectrum, &options, plan);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void cost_sort(int64_t count, double *values) {
    qsort(values, (size_t)count, sizeof *values, ascending);
}

/* Wall time, price and its uncertainty of what was timed so far. The price is the lower quartile: a busy machine lengthens the time on
 * the wall, and the busiest thread's by giving it work of those that wait, while the fastest of few runs is luck. The uncertainty is half
 * of the interquartile range. */
static void summarise(cost_shot *shot) {
    const int64_t n = shot->runs;
    double wall[COST_RUNS_MAX], price[COST_RUNS_MAX];
    memcpy(wall, shot->run_wall_ms, (size_t)n * sizeof *wall);
    memcpy(price, shot->run_price_ms, (size_t)n * sizeof *price);
    cost_sort(n, wall);
    cost_sort(n, price);
    shot->wall_now_ms = 0.5 * (wall[(n - 1) / 2] + wall[n / 2]);
    shot->price_ms = price[n / 4];
    shot->uncertainty_ms = n < 3 ? (double)NAN : 0.5 * (price[(3 * n) / 4] - price[n / 4]);
}

skg_status cost_time(cost_study *study, cost_run run, void *user, int64_t least, double wish_ms,
                     cost_shot *shot) {
    const double begun = cli_now_ms(), limit_ms = cost_patience_ms(study);
    cost_instant start, end;
    double passed = 0;
    int64_t n = 0;
    while (shot->runs < COST_RUNS_MAX && n < COST_RUNS_MAX / COST_VISITS_MAX &&
           (n < least || passed < wish_ms) && (n < 2 || passed < limit_ms)) {
        cost_begin(&start);
        const skg_status status = run(user);
        if (SKG_FAILED(status)) return status;
        cost_end(&end);
        shot->run_wall_ms[shot->runs] = (end.wall - start.wall) / (double)shot->frames;
        shot->run_price_ms[shot->runs++] = cost_price_ms(study, &start, &end) / (double)shot->frames;
        passed = end.wall - begun;
        n++;
    }
    if (n && shot->visits < COST_VISITS_MAX) shot->visits++;
    if (n) summarise(shot);
    return SKG_OK;
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
    int64_t frames;
} still;

/* One batch of frames. */
static skg_status make_still(void *user) {
    still *its = user;
    skg_job *job = NULL;
    skg_status status = skg_plan_submit(its->plan, its->frames, NULL, 1, &its->output, &job);
    return !SKG_FAILED(status) ? skg_job_wait(&job) : status;
}

static void begin_still(const cost_setting *setting, double *data, int64_t frames, still *its) {
    skg_output_init(&its->output);
    its->output.type = cost_type(setting->precision);
    its->output.data = data;
    its->frames = frames;
}

skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, double *ms) {
    still its = {0};
    skg_status status = cost_plan(study, setting, NULL, &its.plan);
    if (SKG_FAILED(status)) return status;
    begin_still(setting, image, 1, &its);
    const double begun = cli_now_ms();
    status = make_still(&its);
    if (ms) *ms = cli_now_ms() - begun;
    if (!SKG_FAILED(status) && ms &&
        *ms < 4 * cost_patience_ms(study)) { /* the first run of a plan takes longer */
        const double again = cli_now_ms();
        status = make_still(&its);
        *ms = fmin(*ms, cli_now_ms() - again);
    }
    if (!SKG_FAILED(status)) cost_widen(its.output.type, study->pixels, image);
    skg_plan_release(&its.plan);
    return SKG_FAILED(status) ? status : SKG_OK;
}

int cost_find_shot(const cost_study *study, const cost_setting *setting) {
    for (int i = 0; i < study->measured.shot_count; i++)
        if (cost_is_same(study, &study->measured.shots[i].setting, setting)) return i;
    return -1;
}

static skg_status report_plan(const skg_plan *plan, cost_shot *shot) {
    skg_plan_report report;
    skg_plan_report_init(&report);
    skg_status status = skg_plan_report_get(plan, &report);
    shot->nodes = report.nodes;
    shot->planes = report.planes;
    shot->bins = report.bins;
    shot->device_bytes = report.device_bytes;
    return status;
}

skg_status cost_add_shot(cost_study *study, const skg_plan *plan, cost_run run, void *user,
                         const cost_shot *begun, int *number) {
    cost_shot shot = *begun;
    *number = -1;
    if (study->measured.shot_count == COST_SHOTS_MAX) return SKG_ERR_MEMORY;
    skg_status status = cost_time(study, run, user, cost_first_runs(study), cost_first_ms(study), &shot);
    if (!SKG_FAILED(status)) status = report_plan(plan, &shot);
    if (SKG_FAILED(status)) return status;
    shot.total_rms = shot.total_max = (double)NAN;
    *number = study->measured.shot_count++;
    study->measured.shots[*number] = shot;
    return status;
}

/* Keeps the plan for further visits if memory allows. The scene's own is always kept: it is the pulse. */
static void keep_plan(cost_study *study, int number, skg_plan **plan) {
    cost_shot *shot = &study->measured.shots[number];
    if (number != 0 && study->measured.kept_bytes + shot->device_bytes > KEPT_BYTES) {
        skg_plan_release(plan);
        return;
    }
    study->measured.kept_bytes += shot->device_bytes;
    shot->plan = *plan;
    *plan = NULL;
}

/* Runs the scene's own image once: how much its price varies from visit to visit is the unrest of prices. */
static skg_status feel_pulse(cost_study *study) {
    cost_shot *own = &study->measured.shots[study->measured.here];
    still its = {.plan = own->plan};
    if (!own->plan) return SKG_OK;
    if (study->measured.pulse_count == study->measured.pulse_capacity) {
        const int64_t capacity = study->measured.pulse_capacity ? 2 * study->measured.pulse_capacity : 64;
        double *larger = realloc(study->measured.pulse_ms, (size_t)capacity * sizeof *larger);
        if (!larger) return SKG_ERR_MEMORY;
        study->measured.pulse_ms = larger;
        study->measured.pulse_capacity = capacity;
    }
    begin_still(&own->setting, study->batch, study->frames, &its);
    cost_instant begun, end;
    cost_begin(&begun);
    const skg_status status = make_still(&its);
    cost_end(&end);
    study->measured.pulse_ms[study->measured.pulse_count++] =
        cost_price_ms(study, &begun, &end) / (double)study->frames;
    return status;
}

/* Plans a setting, and computes its first image, [pixels]. The plan is released by the caller also after a failure. */
static skg_status begin_shot(cost_study *study, const cost_setting *setting, skg_scene *scene, double *image,
                             still *its, cost_shot *shot) {
    const double begun = cli_now_ms();
    skg_status status = cost_plan(study, setting, scene, &its->plan);
    *shot = (cost_shot){.setting = *setting, .plan_ms = cli_now_ms() - begun, .frames = study->frames};
    begin_still(setting, image, 1, its);
    if (!SKG_FAILED(status)) status = make_still(its);
    if (!SKG_FAILED(status)) cost_widen(its->output.type, study->pixels, image);
    return status;
}

skg_status cost_shoot(cost_study *study, const cost_setting *setting, double *image, int *number) {
    still its = {0};
    cost_shot shot;
    *number = cost_find_shot(study, setting);
    if (*number >= 0) return cost_image(study, setting, image, NULL);
    skg_status status = begin_shot(study, setting, NULL, image, &its, &shot);
    begin_still(setting, study->batch, study->frames, &its);
    if (!SKG_FAILED(status) && study->measured.shot_count) status = feel_pulse(study);
    if (!SKG_FAILED(status)) status = cost_add_shot(study, its.plan, make_still, &its, &shot, number);
    if (!SKG_FAILED(status)) keep_plan(study, *number, &its.plan);
    skg_plan_release(&its.plan);
    return SKG_FAILED(status) ? status : SKG_OK;
}

skg_status cost_shoot_scene(cost_study *study, skg_scene *scene, double *batch, double *image,
                            cost_shot *shot) {
    still its = {0};
    skg_status status = begin_shot(study, &study->subject.own, scene, image, &its, shot);
    begin_still(&study->subject.own, batch, study->frames, &its);
    if (!SKG_FAILED(status))
        status = cost_time(study, make_still, &its, cost_first_runs(study), cost_first_ms(study), shot);
    skg_plan_release(&its.plan);
    return SKG_FAILED(status) ? status : SKG_OK;
}

static skg_status visit(cost_study *study, int number) {
    cost_shot *shot = &study->measured.shots[number];
    still its = {.plan = shot->plan};
    skg_status status = feel_pulse(study);
    if (!SKG_FAILED(status) && !its.plan) status = cost_plan(study, &shot->setting, NULL, &its.plan);
    begin_still(&shot->setting, study->batch, study->frames, &its);
    if (!SKG_FAILED(status) && !shot->plan)
        status = make_still(&its); /* the first frame of a plan takes longer */
    if (!SKG_FAILED(status))
        status = cost_time(study, make_still, &its, 2, 0.25 * cost_first_ms(study), shot);
    if (!shot->plan) skg_plan_release(&its.plan);
    return status;
}

/* The time that another visit takes. */
static double visit_ms(const cost_study *study, const cost_shot *shot) {
    const double run = shot->wall_now_ms * (double)study->frames;
    return fmax(2 * run, 0.25 * cost_first_ms(study)) + (shot->plan ? 0 : shot->plan_ms + run);
}

skg_status cost_visit_again(cost_study *study, double share) {
    skg_status status = SKG_OK;
    for (int round = 0; round < 3; round++)
        for (int i = 0; i < study->measured.shot_count && !SKG_FAILED(status); i++) {
            const cost_shot *shot = &study->measured.shots[i];
            if (shot->setting.relaxation >= 0 || shot->visits == COST_VISITS_MAX) continue;
            if (visit_ms(study, shot) > cost_left_ms(study, share)) continue;
            status = visit(study, i);
        }
    return SKG_FAILED(status) ? status : SKG_OK;
}
