/* Sweeps the dials one after another, with a forecast of the time. */
#include "cost/measuring.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/dials.h"

#include <math.h>
#include <stdlib.h>

/* Shares of the given time: after them no other setting of the kind is begun. The rest is for the recommended settings and
 * for writing. */
static const double SWEPT = 0.6, COMBINED = 0.72, TIMED = 0.86;
static const double ALL = 6;    /* an image of COST_OF_ALL may take so many times the time of a setting's */
static const double LEFT = 0.3; /* and this share of the time that is left */

static double making_ms(const cost_study *study, const cost_setting *setting) {
    return setting->meshing < 0 ? 0 : cost_making_ms(study, &study->meshings[setting->meshing]);
}

/* Estimated time to measure a point, ms, with its reference if that is not made yet. */
static double effort_ms(const cost_study *study, const cost_point *point) {
    const cost_reference *reference = &study->measured.references[point->reference];
    const double phases = point->reference == COST_OF_BREATH ? COST_PHASES : 1;
    double ms = phases * cost_effort_ms(study, &point->setting);
    if (!reference->image)
        ms += study->measured.plan_ms + cost_estimate_ms(study, &reference->setting) +
              making_ms(study, &reference->setting);
    return ms + making_ms(study, &point->setting);
}

/* The next point to measure: the smallest priority, then the least effort. -1: none is left. */
static int next_point(const cost_study *study) {
    int next = -1;
    for (int i = 0; i < study->measured.count; i++) {
        const cost_point *a = &study->measured.points[i], *b = &study->measured.points[next < 0 ? 0 : next];
        if (a->state != COST_PLANNED) continue;
        if (next < 0 || a->priority < b->priority ||
            (a->priority == b->priority && effort_ms(study, a) < effort_ms(study, b)))
            next = i;
    }
    return next;
}

/* Time left: that of the planned points, or the given time if they need more. */
static void forecast(const cost_study *study, int64_t done) {
    double ms = 0;
    for (int i = 0; i < study->measured.count; i++)
        if (study->measured.points[i].state == COST_PLANNED)
            ms += effort_ms(study, &study->measured.points[i]);
    cli_progress_forecast("measuring settings", done, study->measured.count,
                          fmin(ms / SWEPT, fmax(cost_left_ms(study, 1), 0)));
}

static int measure_all(cost_study *study, double *image) {
    int exit_status = CLI_DONE, index;
    for (int64_t done = 0; exit_status == CLI_DONE && (index = next_point(study)) >= 0; done++) {
        cost_point *point = &study->measured.points[index];
        forecast(study, done);
        if (point->priority > 0 && effort_ms(study, point) > cost_left_ms(study, SWEPT)) {
            point->state = COST_LEFT_OUT;
            study->left_out++;
            continue;
        }
        exit_status = cost_measure(study, point, image);
    }
    return exit_status;
}

/* Removes the points that were not measured. The others stay in the order of their work. */
static void drop_unmeasured(cost_study *study) {
    int kept = 0;
    study->planned = study->measured.count;
    for (int i = 0; i < study->measured.count; i++)
        if (study->measured.points[i].state == COST_MEASURED)
            study->measured.points[kept++] = study->measured.points[i];
    study->measured.count = kept;
}

/* The scene as it is: its image and its time, from which those of the others are estimated. */
static int look_at_own(cost_study *study, double *image) {
    skg_status status = cost_shoot(study, &study->subject.own, image, &study->measured.here);
    if (SKG_FAILED(status)) return cli_fail(status);
    study->measured.pass_ms =
        study->measured.shots[study->measured.here].wall_now_ms / cost_passes(&study->subject.own);
    study->measured.plan_ms = study->measured.shots[study->measured.here].plan_ms;
    return CLI_DONE;
}

/* The root mean square of the scene's noise. image: the scene without noise. */
static int find_noise(cost_study *study, const double *image) {
    const skg_plan_options *options = &study->session.options;
    if (!options->noise && !(options->electronic_kev > 0)) return CLI_DONE;
    double *noisy = calloc((size_t)study->pixels, sizeof *noisy), squares = 0;
    if (!noisy) return cli_error(CLI_DEVICE, "out of host memory for the image");
    study->subject.noisy = 1;
    skg_status status = cost_image(study, &study->subject.own, noisy, NULL);
    study->subject.noisy = 0;
    for (int64_t i = 0; i < study->pixels; i++) squares += (noisy[i] - image[i]) * (noisy[i] - image[i]);
    study->subject.noise = sqrt(squares / (double)study->pixels) / study->subject.flat_field;
    free(noisy);
    return SKG_FAILED(status) ? cli_fail(status) : CLI_DONE;
}

/* The best of every dial: as many samples and rays a pixel as the time allows, with the scene's own precision, tolerance and
 * bins, because the best ones take ten times longer; what those change is added, from images with the scene's own samples.
 * own: the scene's image. */
static int make_best(cost_study *study, const double *own) {
    cost_reference *best = &study->measured.references[COST_OF_ALL];
    const cost_reference *rays = &study->measured.references[COST_OF_RAYS];
    best->setting =
        cost_best_of_all(study, fmin(ALL * cost_patience_ms(study), LEFT * cost_left_ms(study, 1)));
    const int exit_status = cost_make_reference(study, COST_OF_ALL);
    if (exit_status != CLI_DONE) return exit_status;
    for (int64_t i = 0; i < study->pixels; i++) best->image[i] += rays->image[i] - own[i];
    best->setting.precision = rays->setting.precision;
    best->setting.tolerance = rays->setting.tolerance;
    best->setting.bins = rays->setting.bins;
    return CLI_DONE;
}

/* The references that everything is compared with. own: the scene's image. */
static int make_first_references(cost_study *study, const double *own) {
    cost_setting best = study->subject.own;
    best.tolerance = 0;
    best.bins = study->subject.finest;
    best.precision = study->session.device.double_precision ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    study->measured.references[COST_OF_RAYS].setting = best;
    const int exit_status = cost_make_reference(study, COST_OF_RAYS);
    return exit_status == CLI_DONE ? make_best(study, own) : exit_status;
}

static int measure_in_turn(cost_study *study, double *image) {
    cli_progress_forecast("timing the scene as it is", 0, 0, study->within_ms);
    int exit_status = look_at_own(study, image);
    if (exit_status == CLI_DONE) exit_status = find_noise(study, image);
    cli_progress_forecast("measuring every source of error coarsely", 0, 0, fmax(cost_left_ms(study, 1), 0));
    if (exit_status == CLI_DONE) exit_status = cost_measure_coarsely(study, image);
    cost_limit_meshings(study);
    cli_progress_forecast("computing the best image, with which others are compared", 0, 0,
                          fmax(cost_left_ms(study, 1), 0));
    if (exit_status == CLI_DONE) exit_status = make_first_references(study, image);
    if (exit_status != CLI_DONE) return exit_status;
    cost_choose_settings(study);
    exit_status = measure_all(study, image);
    if (exit_status == CLI_DONE) exit_status = cost_combine(study, COMBINED, image);
    drop_unmeasured(study);
    if (exit_status != CLI_DONE) return exit_status;
    cli_progress_forecast("timing every setting again", 0, 0, fmax(cost_left_ms(study, TIMED), 0));
    const skg_status status = cost_visit_again(study, TIMED);
    return SKG_FAILED(status) ? cli_fail(status) : CLI_DONE;
}

int cost_sweep(cost_study *study) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    study->batch = calloc((size_t)(study->frames * study->pixels), sizeof *study->batch);
    const int enough = image && study->batch;
    if (!study->session.device.double_precision)
        cost_note(study, "the device has no fp64: single precision is compared with itself");
    if (study->session.options.spot && study->session.options.spot->grid > 0)
        cost_note(study, "source samples are not swept: the scene fixes them by a grid");
    const int exit_status =
        enough ? measure_in_turn(study, image)
               : cli_error(CLI_DEVICE, "out of host memory for %lld images", (long long)study->frames + 1);
    free(image);
    return exit_status;
}
