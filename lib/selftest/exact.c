/* A scene of which every sum is a known integer.
 *
 * Under a parallel beam along z, with pixels of 1 mm and a path of 1024 mm, the faces of these boxes have depths whose
 * numerators are small and whose denominators are powers of two. So are their gradients, since their sides are. No step of
 * the kernels rounds, and every path length is exact: one bit that is wrong is found. */
#include "selftest/selftest.h"

#include <skiagraph/frame.h>
#include <skiagraph/plan.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = SKG_SELF_TEST_PIXELS, PIXELS = N * N, BOXES = 12 };

typedef struct {
    skg_scene *scene;
    skg_spectrum *beam;
    skg_plan *plan;
    skg_view view;
    skg_box boxes[BOXES];
    float lengths[PIXELS];
} exact_run;

/* Boxes of all sizes that lean by a quarter to one millimetre per millimetre of depth. No side is seen along a row or a
 * column of pixels, whose centres are at odd multiples of 1/2. */
static void place_boxes(exact_run *run) {
    for (int b = 0; b < BOXES; b++) {
        const double across = ldexp(0.25, b % 8), down = ldexp(0.25, (b * 3 + 2) % 8), deep = ldexp(2, b % 4);
        const double lean[2] = {ldexp(b % 2 ? 1 : -1, -(b % 3)), ldexp(b % 4 < 2 ? 1 : -1, -((b + 1) % 3))};
        run->boxes[b] = (skg_box){.centre = {7 * (b % 5) - 14.125, 9 * (b % 4) - 13.625, 4 * (b % 7) - 12},
                                  .half = {across, down, deep},
                                  .axes = {1, 0, 0, 0, 1, 0, lean[0], lean[1], 1}};
    }
}

/* The length of the line along z through (x, y) within a leaning box; without rounding. */
static double length_in(const skg_box *box, const double *place) {
    double low = -box->half[2], high = box->half[2]; /* of z from the centre */
    for (int k = 0; k < 2; k++) {
        const double lean = box->axes[6 + k], beside = place[k] - box->centre[k];
        const double a = (beside - box->half[k]) / lean, b = (beside + box->half[k]) / lean;
        low = fmax(low, fmin(a, b));
        high = fmin(high, fmax(a, b));
    }
    return fmax(0, high - low);
}

static skg_status make_scene(skg_context *context, exact_run *run) {
    skg_part part;
    skg_part_init(&part);
    skg_view_init(&run->view);
    run->view.projection = SKG_PROJECTION_PARALLEL;
    run->view.columns = run->view.rows = N;
    run->view.source[2] = -512;
    run->view.centre[2] = 512;
    run->view.column_step[0] = run->view.row_step[1] = 1;
    place_boxes(run);
    SKG_TRY(skg_scene_create(context, &run->scene));
    SKG_TRY(skg_spectrum_create_mono(100, 1, &run->beam));
    skg_status status = skg_boxes_mesh(context, run->boxes, BOXES, 0, &part.mesh);
    if (status == SKG_OK) status = skg_material_create_mu("boxes", 0.1, &part.material);
    part.label = "boxes";
    if (status == SKG_OK) status = skg_scene_part_add(run->scene, &part, NULL);
    skg_material_release(&part.material);
    skg_mesh_release(&part.mesh);
    return status;
}

static skg_status render(skg_context *context, int32_t strategy, exact_run *run) {
    skg_plan_options options;
    skg_output output;
    skg_job *job = NULL;
    skg_plan_options_init(&options);
    skg_output_init(&output);
    options.overlaps = 0;
    options.strategy = strategy;
    output.data = run->lengths;
    output.type = SKG_TYPE_FLOAT32;
    skg_plan_release(&run->plan);
    SKG_TRY(skg_plan_create(context, run->scene, &run->view, run->beam, &options, &run->plan));
    output.kind = SKG_OUTPUT_LENGTHS;
    output.lengths = SKG_LENGTHS_SURFACE;
    SKG_TRY(skg_plan_submit(run->plan, 1, NULL, 1, &output, &job));
    const skg_status status = skg_job_wait(&job);
    return SKG_FAILED(status) ? status : SKG_OK;
}

static void compare(const exact_run *run, const char *strategy, skg_verdict *verdict) {
    int wrong = 0;
    for (int p = 0; p < PIXELS; p++) {
        const double place[2] = {p % N - 0.5 * (N - 1), p / N - 0.5 * (N - 1)};
        double length = 0;
        for (int b = 0; b < BOXES; b++) length += length_in(&run->boxes[b], place);
        if ((double)run->lengths[p] == length) continue;
        if (wrong++ == 0)
            snprintf(
                verdict->reason, sizeof verdict->reason,
                "with strategy %s, pixel (%d, %d) has a path length of %.9g mm instead of %.9g mm, the first",
                strategy, p / N, p % N, (double)run->lengths[p], length);
    }
    verdict->good = wrong == 0;
    const size_t used = strlen(verdict->reason);
    if (wrong) snprintf(verdict->reason + used, sizeof verdict->reason - used, " of %d", wrong);
}

skg_status skg_self_test_exact(skg_context *context, skg_verdict *verdict) {
    static const struct {
        int32_t number;
        const char *name;
    } strategies[] = {
        {SKG_STRATEGY_COPIES, "copies"}, {SKG_STRATEGY_TILES, "tiles"}, {SKG_STRATEGY_ATOMICS, "atomics"}};
    exact_run *run = NULL;
    skg_status status = SKG_OK;
    *verdict = (skg_verdict){.good = 1};
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    SKG_TRY_CLEANUP(make_scene(context, run));
    for (int k = 0; k < 3 && verdict->good; k++) {
        SKG_TRY_CLEANUP(render(context, strategies[k].number, run));
        compare(run, strategies[k].name, verdict);
    }
cleanup:
    skg_plan_release(&run->plan);
    skg_scene_release(&run->scene);
    skg_spectrum_release(&run->beam);
    skg_free(&run);
    return status;
}
