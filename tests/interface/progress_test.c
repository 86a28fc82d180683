/* Progress and cancellation of long work on the host: the same for distances, reconstructions and scans. */
#include "suite.h"

#include <skiagraph/breathing.h>
#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <pthread.h>
#include <stdlib.h>

enum { SIDE = 16, PROJECTIONS = 40, NEVER = 1 << 30 };

/* Calls that a callback received, and the one at which it cancels. */
typedef struct {
    int64_t calls, done, total;
    int64_t cancel_at; /* the number of the call, from 0 */
} listener;

static int32_t hear(int64_t done, int64_t total, void *user) {
    listener *l = user;
    ck_assert(done >= l->done && done <= total && (l->calls == 0 || total == l->total));
    l->done = done;
    l->total = total;
    return l->calls++ == l->cancel_at;
}

static skg_progress *progress_of(listener *l, int64_t cancel_at) {
    skg_progress *progress = NULL;
    *l = (listener){.cancel_at = cancel_at};
    ck_skg(skg_progress_create(hear, l, &progress));
    return progress;
}

/* A point source and a detector that turn about z. */
static skg_scan *turn(void) {
    skg_scan *scan = NULL;
    skg_scan_options options;
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[1] = -300, view.centre[1] = 100;
    view.column_step[0] = view.row_step[2] = 2;
    skg_scan_options_init(&options);
    options.projections = PROJECTIONS;
    options.step_rad = 6.283185307179586 / PROJECTIONS;
    ck_skg(skg_scan_create(&view, &options, &scan));
    return scan;
}

/* --- the object */

static void *cancel(void *progress) {
    ck_skg(skg_progress_cancel(progress));
    return NULL;
}

START_TEST(an_object_is_asked_and_cancelled) {
    skg_progress *progress = NULL;
    int64_t done = -1, total = -1;
    pthread_t thread;
    ck_skg(skg_progress_create(NULL, NULL, &progress));
    ck_skg(skg_progress_get(progress, &done, &total));
    ck_assert(done == 0 && total == 0);
    ck_skg(skg_progress_get(progress, NULL, NULL));
    ck_skg(skg_progress_retain(progress));
    skg_progress *other = progress;
    skg_progress_release(&other);
    ck_assert_ptr_null(other);
    ck_assert_int_eq(pthread_create(&thread, NULL, cancel, progress), 0);
    pthread_join(thread, NULL);
    skg_progress_release(&progress);
    skg_progress_release(&progress);
    skg_progress_release(NULL);
    ck_skg_fails(skg_progress_create(NULL, NULL, NULL), SKG_ERR_ARGUMENT, "progress");
    ck_skg_fails(skg_progress_get(NULL, &done, &total), SKG_ERR_ARGUMENT, "progress");
    ck_skg_fails(skg_progress_cancel(NULL), SKG_ERR_ARGUMENT, "progress");
}
END_TEST

/* --- distances */

START_TEST(distances) {
    skg_mesh *meshes[2] = {NULL, NULL};
    skg_distance_options options;
    skg_distance plain, found;
    listener l;
    for (int m = 0; m < 2; m++) ck_skg(skg_mesh_create_sphere(10 + m, 48, &meshes[m]));
    skg_distance_options_init(&options);
    skg_distance_init(&plain);
    ck_skg(skg_distance_measure(meshes[0], meshes[1], &options, &plain));
    options.progress = progress_of(&l, NEVER);
    skg_distance_init(&found);
    ck_skg(skg_distance_measure(meshes[0], meshes[1], &options, &found));
    ck_assert(l.calls > 4 && l.done == l.total && l.total == found.samples);
    ck_assert(found.mean_mm == plain.mean_mm && found.max_mm == plain.max_mm);
    skg_progress_release(&options.progress);
    const int64_t calls[2] = {0, l.calls / 2}, last = l.calls - 1;
    for (int k = 0; k < 2; k++) {
        options.progress = progress_of(&l, calls[k]);
        ck_skg_fails(skg_distance_measure(meshes[0], meshes[1], &options, &found), SKG_ERR_CANCELLED,
                     "cancelled after");
        ck_assert_int_eq(l.calls, calls[k] + 1);
        skg_progress_release(&options.progress);
    }
    options.progress = progress_of(&l, last); /* too late */
    ck_skg(skg_distance_measure(meshes[0], meshes[1], &options, &found));
    ck_skg_fails(skg_distance_measure(meshes[0], meshes[1], &options, &found), SKG_ERR_CANCELLED, "");
    skg_progress_release(&options.progress);
    for (int m = 0; m < 2; m++) skg_mesh_release(&meshes[m]);
}
END_TEST

/* --- reconstructions */

/* Adds projections until one is refused, and returns their number. */
static int64_t reconstruct(int64_t cancel_at, listener *l) {
    static const float image[SIDE * SIDE] = {0};
    skg_scan *scan = turn();
    skg_fdk *fdk = NULL;
    skg_fdk_options options;
    int64_t added = 0;
    skg_status status = SKG_OK;
    skg_fdk_options_init(&options);
    for (int k = 0; k < 3; k++) options.voxels[k] = 4;
    options.progress = progress_of(l, cancel_at);
    ck_skg(skg_fdk_create(scan, &options, &fdk));
    skg_progress_release(&options.progress); /* the reconstruction has retained it */
    for (; added < PROJECTIONS && status == SKG_OK; added += status == SKG_OK)
        status = skg_fdk_add(fdk, added, image);
    ck_assert_int_eq(status, added < PROJECTIONS ? SKG_ERR_CANCELLED : SKG_OK);
    skg_fdk_release(&fdk);
    skg_scan_release(&scan);
    return added;
}

START_TEST(reconstructions) {
    listener l;
    ck_assert_int_eq(reconstruct(0, &l), 0);
    ck_assert_int_eq(reconstruct(7, &l), 7);
    ck_assert(l.done == 7 && l.total == PROJECTIONS);
    ck_assert_int_eq(reconstruct(PROJECTIONS, &l), PROJECTIONS); /* the call after the last one */
    ck_assert_int_eq(l.done, PROJECTIONS);
}
END_TEST

/* --- scans */

static skg_context *context;
static skg_scene *scene;
static skg_plan *plan;

static void open_plan(void) {
    skg_mesh *cube = NULL;
    skg_material *water = NULL;
    skg_spectrum *beam = NULL;
    skg_part part;
    skg_view view;
    skg_scan *scan = turn();
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_mesh_create_cube(10, &cube));
    ck_skg(skg_material_create_mu("water", 0.2, &water));
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_scene_create(context, &scene));
    skg_part_init(&part);
    part.mesh = cube, part.material = water, part.label = "cube";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_view_init(&view);
    ck_skg(skg_scan_view_get(scan, 0, &view));
    ck_skg(skg_plan_create(context, scene, &view, beam, NULL, &plan));
    skg_scan_release(&scan);
    skg_spectrum_release(&beam);
    skg_material_release(&water);
    skg_mesh_release(&cube);
}

static void close_plan(void) {
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

static skg_status count(const skg_scan_batch *batch, void *user) {
    *(int64_t *)user += batch->count;
    return SKG_OK;
}

START_TEST(scans) {
    enum { BATCH = 4, BATCHES = PROJECTIONS / BATCH };
    skg_scan *scan = turn();
    skg_scan_run_options options;
    listener l;
    skg_scan_run_options_init(&options);
    options.batch = BATCH;
    for (int64_t at = 0; at <= BATCHES; at += BATCHES / 2) { /* first, in the middle, after the last */
        int64_t received = 0;
        options.progress = progress_of(&l, at);
        const skg_status status = skg_scan_run_each(plan, scan, &options, count, &received);
        ck_assert_int_eq(status, at < BATCHES ? SKG_ERR_CANCELLED : SKG_OK);
        ck_assert_int_eq(received, at * BATCH);
        ck_assert(l.done == received && l.total == PROJECTIONS);
        skg_progress_release(&options.progress);
    }
    float image[SIDE * SIDE]; /* the plan is as good as before */
    skg_output output;
    skg_output_init(&output);
    output.data = image;
    ck_skg(skg_plan_image(plan, &output));
    skg_scan_release(&scan);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_plan, close_plan);
    tcase_add_test(tests, an_object_is_asked_and_cancelled);
    tcase_add_test(tests, distances);
    tcase_add_test(tests, reconstructions);
    tcase_add_test(tests, scans);
}

SKG_SUITE_MAIN("progress", add_tests)
