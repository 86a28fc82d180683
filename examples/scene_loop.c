/* Loads a scene file, moves one part of it step by step, and reads the lengths of the rays through that part.
 *
 *     cc scene_loop.c $(pkg-config --cflags --libs skiagraph) -lm -o scene_loop && ./scene_loop scenes/phantom.json marker */
#include <skiagraph/skiagraph.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 5 };
static const double STEP = 10; /* mm along x */

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "%s: %s\n", skg_status_name(status), skg_last_error());
    return SKG_FAILED(status) || status == SKG_STALE; /* after SKG_RANGE the image is there */
}

/* The longest way of a ray through the part, in mm, and the column about which its shadow lies. */
static void look(const float *lengths, const skg_view *view, double *longest, double *column) {
    double sum = 0, moment = 0;
    *longest = 0;
    for (int64_t i = 0; i < view->columns * view->rows; i++) {
        const double length = (double)lengths[i];
        sum += length, moment += length * (double)(i % view->columns);
        if (length > *longest) *longest = length;
    }
    *column = sum > 0 ? moment / sum : -1;
}

/* Each step sets the pose, asks for the lengths and waits. The plan takes up the pose by itself. */
static int run(skg_plan *plan, skg_scene *scene, int64_t id, const skg_view *view, float *lengths) {
    double pose[16], first = 0, column = 0, longest = 0;
    skg_part part;
    skg_output output;
    skg_part_init(&part);
    skg_output_init(&output);
    output.data = lengths;
    if (failed(skg_scene_part_get(scene, id, &part))) return 1;
    memcpy(pose, part.pose, sizeof pose);
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = id;
    output.lengths = SKG_LENGTHS_SURFACE;
    for (int step = 0; step < STEPS; step++, pose[3] += STEP) {
        skg_job *job = NULL;
        if (failed(skg_scene_part_pose_set(scene, id, pose)) ||
            failed(skg_plan_submit(plan, 1, NULL, 1, &output, &job)) || failed(skg_job_wait(&job)))
            return 1;
        look(lengths, view, &longest, &column);
        if (step == 0) first = column;
        printf("%s moved by %g mm: up to %.2f mm thick, its shadow about column %.1f\n", part.label,
               step * STEP, longest, column);
    }
    if (longest > 0 && column != first) return 0;
    fprintf(stderr, "scene_loop: the shadow did not move\n");
    return 1;
}

int main(int count, char **words) {
    skg_context *context = NULL;
    skg_setup *setup = NULL;
    skg_scene *scene = NULL; /* the scene and the spectrum belong to the set-up */
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    float *lengths = NULL;
    int64_t id = -1;
    skg_view view;
    skg_plan_options options;
    if (count != 3) {
        fprintf(stderr, "usage: scene_loop SCENE LABEL\n");
        return 2;
    }
    skg_view_init(&view);
    skg_plan_options_init(&options);
    int bad = failed(skg_context_create(NULL, &context)) ||
              failed(skg_setup_load(context, words[1], 0, NULL, &setup)) ||
              failed(skg_setup_scene_get(setup, &scene)) ||
              failed(skg_setup_spectrum_get(setup, &spectrum)) || failed(skg_setup_view_get(setup, &view)) ||
              failed(skg_setup_options_get(setup, &options)) ||
              failed(skg_scene_part_find(scene, words[2], &id)) ||
              failed(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    if (!bad) lengths = calloc((size_t)(view.columns * view.rows), sizeof *lengths);
    if (!bad) bad = !lengths || run(plan, scene, id, &view, lengths);
    free(lengths);
    skg_plan_release(&plan);
    skg_setup_release(&setup);
    skg_context_release(&context);
    return bad;
}
