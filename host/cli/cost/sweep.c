#include "cost/sweep.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/compare.h"
#include "cost/measure.h"
#include "cost/meshing.h"
#include "cost/phases.h"

#include <math.h>
#include <stdlib.h>

static int is_same(const cost_setting *a, const cost_setting *b) {
    return a->precision == b->precision && a->supersampling == b->supersampling &&
           a->tolerance == b->tolerance && a->bins == b->bins && a->samples == b->samples &&
           a->repair == b->repair && a->meshing == b->meshing && a->relaxation == b->relaxation &&
           a->hysteresis == b->hysteresis;
}

/* Adds a point to be measured, unless it exists already or would take too long. */
static void add(cost_study *study, int dial, int reference, cost_setting setting) {
    for (int i = 0; i < study->count; i++)
        if (study->points[i].reference == reference && is_same(&study->points[i].setting, &setting)) return;
    if (study->count == COST_MOST_POINTS) return;
    if (study->pass_ms * cost_passes(&setting) > cost_patience_ms(study)) {
        char text[160];
        cost_describe(study, &setting, text, sizeof text);
        cost_note(study, "%s left out: one image would take about %.3g s", text,
                  1e-3 * study->pass_ms * cost_passes(&setting));
        return;
    }
    study->points[study->count++] = (cost_point){.dial = dial, .reference = reference, .setting = setting};
}

/* Precision, tolerance and bins: the dials of a single ray. */
static void add_rays(cost_study *study) {
    static const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
    static const int64_t bins[] = {64, 32, 16, 8, 4};
    const int step = study->quick ? 2 : 1;
    const int32_t twice = study->session.device.has_double;
    cost_setting exact = study->own;
    exact.tolerance = 0;
    exact.bins = study->finest;
    add(study, COST_SCENE, COST_OF_RAYS, study->own);
    static const int32_t precisions[] = {SKG_PRECISION_HALF, SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE};
    for (int i = 0; i < 2 + twice; i++) {
        exact.precision = precisions[i];
        add(study, COST_PRECISION, COST_OF_RAYS, exact);
    }
    if (!study->has_energies) return;
    cost_setting its = exact;
    for (int32_t precision = SKG_PRECISION_SINGLE;
         precision <= (twice ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE); precision++)
        for (int i = step - 1; i < 6; i += step) {
            its.precision = precision;
            its.tolerance = tolerances[i];
            add(study, COST_TOLERANCE, COST_OF_RAYS, its);
        }
    its.precision = SKG_PRECISION_SINGLE;
    for (int i = 0; study->has_tube && i < 5; i += step) {
        if (!cost_has_bins(study, bins[i])) break; /* wider than the tube's model allows */
        its.bins = bins[i];
        its.tolerance = 0;
        add(study, COST_BINS, COST_OF_RAYS, its);
        its.tolerance = 1e-4;
        add(study, COST_BINS, COST_OF_RAYS, its);
    }
}

/* Powers of two of source samples, against four times the largest of them. */
static void add_samples(cost_study *study) {
    cost_setting its = study->own;
    if (!study->has_spot) return;
    const int64_t most = study->quick ? 64 : 1024;
    its.samples = 4 * most;
    while (its.samples > 16 && study->pass_ms * cost_passes(&its) > 3 * cost_patience_ms(study))
        its.samples /= 4;
    study->references[COST_OF_SAMPLES].setting = its;
    for (int64_t n = 1; 4 * n <= study->references[COST_OF_SAMPLES].setting.samples;
         n *= study->quick ? 4 : 2) {
        its.samples = n;
        add(study, COST_SAMPLES, COST_OF_SAMPLES, its);
    }
}

/* Rays per side of a pixel, against at least twice as many. At most 16 source samples, to save time. */
static void add_supersampling(cost_study *study) {
    static const int32_t sides[] = {1, 2, 3, 4, 6, 8};
    cost_setting its = study->own;
    if (its.samples > 16) its.samples = 16;
    its.supersampling = study->quick ? 8 : 16;
    while (its.supersampling > 2 && study->pass_ms * cost_passes(&its) > 3 * cost_patience_ms(study))
        its.supersampling /= 2;
    const int32_t most = its.supersampling;
    study->references[COST_OF_AREAS].setting = its;
    for (int i = 0; i < 6 && 2 * sides[i] <= most; i++) {
        its.supersampling = sides[i];
        add(study, COST_SUPERSAMPLING, COST_OF_AREAS, its);
    }
}

/* Repair of the pixels where the hits of a leaky mesh do not cancel, against the exact repair. */
static void add_repair(cost_study *study) {
    cost_setting its = study->own;
    for (its.repair = SKG_REPAIR_NONE; study->has_leaky && its.repair <= SKG_REPAIR_EXACT; its.repair++)
        add(study, COST_REPAIR, COST_OF_REPAIR, its);
    its.repair = SKG_REPAIR_EXACT;
    study->references[COST_OF_REPAIR].setting = its;
}

/* Meshings in rising order, the scene's own among them, against the finest. */
static void add_triangles(cost_study *study) {
    cost_setting its = study->own;
    int has_own = 0;
    for (int i = 0; i + 1 < study->meshing_count; i++) {
        const int64_t triangles = study->meshings[i].triangles;
        its.meshing = -1;
        if (!has_own && triangles >= study->triangles)
            has_own = 1, add(study, COST_TRIANGLES, COST_OF_TRIANGLES, its);
        its.meshing = i;
        if (triangles != study->triangles) add(study, COST_TRIANGLES, COST_OF_TRIANGLES, its);
    }
    its.meshing = -1;
    if (!has_own && study->meshing_count) add(study, COST_TRIANGLES, COST_OF_TRIANGLES, its);
    its.meshing = study->meshing_count - 1;
    study->references[COST_OF_TRIANGLES].setting = its;
}

/* Relaxation and hysteresis, against no relaxation with the scene's hysteresis. */
static void add_breath(cost_study *study) {
    static const int32_t relaxations[] = {0, 1, 2, 5, 10, 20};
    static const double hystereses[] = {0, 0.25, 0.5, 0.75, 1};
    cost_setting its = study->own;
    if (!study->has_breath) return;
    its.hysteresis = study->body.hysteresis;
    its.relaxation = 0;
    study->references[COST_OF_BREATH].setting = its;
    for (int i = 0; i < 6; i += study->quick ? 2 : 1) {
        its.relaxation = relaxations[i];
        add(study, COST_RELAXATION, COST_OF_BREATH, its);
    }
    its.relaxation = study->body.relaxation;
    add(study, COST_RELAXATION, COST_OF_BREATH, its);
    for (int i = 0; i < 5; i += study->quick ? 4 : 1) {
        its.hysteresis = hystereses[i];
        add(study, COST_HYSTERESIS, COST_OF_BREATH, its);
    }
}

static int make_reference(cost_study *study, int number) {
    cost_reference *reference = &study->references[number];
    if (number == COST_OF_BREATH) {
        int exit_status = CLI_DONE;
        if (cost_breathe(study, &reference->setting, NULL, &exit_status) >= SKG_OK) return exit_status;
        cost_note(study, "relaxation and hysteresis are not swept: %s", skg_last_error());
        return CLI_DONE;
    }
    reference->image = calloc((size_t)study->pixels, sizeof *reference->image);
    if (!reference->image) return cli_error(CLI_DEVICE, "out of host memory for the image");
    skg_status status = cost_image(study, &reference->setting, reference->image, NULL);
    return status < SKG_OK ? cli_fail(status) : CLI_DONE;
}

/* Makes the references that points are compared with. */
static int make_references(cost_study *study) {
    int exit_status = CLI_DONE;
    for (int number = 0; number < COST_REFERENCES && exit_status == CLI_DONE; number++) {
        int is_needed = number == COST_OF_RAYS;
        for (int i = 0; i < study->count; i++) is_needed |= study->points[i].reference == number;
        if (is_needed) exit_status = make_reference(study, number);
    }
    return exit_status;
}

/* Times one image of the scene, to estimate the times of the others. */
static int find_pass_time(cost_study *study, double *image) {
    cost_point point = {0};
    skg_status status = cost_image(study, &study->own, image, &point);
    study->pass_ms = point.median_ms / cost_passes(&study->own);
    return status < SKG_OK ? cli_fail(status) : CLI_DONE;
}

/* The root mean square of the scene's noise. image: the scene without noise. */
static int find_noise(cost_study *study, const double *image) {
    const skg_plan_options *options = &study->session.options;
    if (!options->noise && !(options->electronic_kev > 0)) return CLI_DONE;
    double *noisy = calloc((size_t)study->pixels, sizeof *noisy), squares = 0;
    if (!noisy) return cli_error(CLI_DEVICE, "out of host memory for the image");
    study->noisy = 1;
    skg_status status = cost_image(study, &study->own, noisy, NULL);
    study->noisy = 0;
    for (int64_t i = 0; i < study->pixels; i++) squares += (noisy[i] - image[i]) * (noisy[i] - image[i]);
    study->noise = sqrt(squares / (double)study->pixels) / study->flat_field;
    free(noisy);
    return status < SKG_OK ? cli_fail(status) : CLI_DONE;
}

/* A setting that the scene does not allow (half with a leaky mesh), or that lacks memory, is noted and left
 * out. */
static int measure(cost_study *study, cost_point *point, double *image, int *keep) {
    const cost_reference *reference = &study->references[point->reference];
    const int breathes = point->reference == COST_OF_BREATH;
    int exit_status = CLI_DONE;
    *keep = 0;
    if (!reference->image) return CLI_DONE; /* make_reference has noted why */
    skg_status status = breathes ? cost_breathe(study, &point->setting, point, &exit_status)
                                 : cost_image(study, &point->setting, image, point);
    if (exit_status != CLI_DONE) return exit_status;
    *keep = status >= SKG_OK;
    if (status == SKG_ERR_DEVICE || status == SKG_ERR_INTERNAL || status == SKG_ERR_NO_DEVICE)
        return cli_fail(status);
    if (!*keep) {
        char text[160];
        cost_describe(study, &point->setting, text, sizeof text);
        cost_note(study, "%s left out: %s", text, skg_last_error());
        return CLI_DONE;
    }
    if (breathes) return CLI_DONE;
    exit_status = cost_compare(study, 1, image, reference->image, point);
    const int dial = point->dial;
    if (exit_status == CLI_DONE &&
        (dial == COST_PRECISION || dial == COST_SCENE || dial == COST_REPAIR || dial == COST_TRIANGLES))
        cost_compare_lengths(study, &reference->setting, point);
    return exit_status;
}

static int measure_all(cost_study *study, double *image) {
    const int count = study->count;
    int exit_status = CLI_DONE;
    study->count = 0;
    cli_progress_begin("settings", count);
    for (int i = 0; exit_status == CLI_DONE && i < count; i++) {
        int keep = 0;
        cost_point point = study->points[i];
        exit_status = measure(study, &point, image, &keep);
        if (keep) study->points[study->count++] = point;
        cli_progress_step(i + 1);
    }
    cli_progress_end();
    return exit_status;
}

int cost_sweep(cost_study *study) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    if (!image) return cli_error(CLI_DEVICE, "out of host memory for the image");
    cost_setting best = study->own;
    best.tolerance = 0;
    best.bins = study->finest;
    best.precision = study->session.device.has_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    study->references[COST_OF_RAYS].setting = best;
    if (best.precision == SKG_PRECISION_SINGLE)
        cost_note(study, "the device has no fp64: single precision is compared with itself");
    if (study->session.options.spot && study->session.options.spot->grid > 0)
        cost_note(study, "source samples are not swept: the scene fixes them by a grid");
    cli_progress_begin("timing the scene as it is", 0);
    int exit_status = find_pass_time(study, image);
    if (exit_status == CLI_DONE) exit_status = find_noise(study, image);
    cli_progress_begin("making meshes with fewer and with more triangles", 0);
    if (exit_status == CLI_DONE) exit_status = cost_find_meshings(study);
    cli_progress_end();
    if (exit_status == CLI_DONE) {
        add_rays(study);
        add_samples(study);
        add_supersampling(study);
        add_repair(study);
        add_triangles(study);
        add_breath(study);
        cli_progress_begin("computing what settings are compared with", 0);
        exit_status = make_references(study);
        cli_progress_end();
    }
    if (exit_status == CLI_DONE) exit_status = measure_all(study, image);
    free(image);
    return exit_status;
}
