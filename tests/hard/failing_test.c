/* A full run (device, scene file, plan, image, lengths, files) in which one call fails, for each place in the
 * program that makes such a call. The run has to fail with a sentence or to give the right image; nothing may
 * leak, no file may be half there, and the same plan has to work when asked again. */
#include "device/device.h"
#include "hard/failing_calls.h"
#include "hard/failing_gradient.h"
#include "hard/failing_scan.h"
#include "hard/failing_scenes.h"
#include "hard/failing_series.h"
#include "hard/failing_shared.h"
#include "suite.h"

#include <skiagraph/breathing.h>
#include <skiagraph/skiagraph.h>

#include <dirent.h>
#include <jansson.h>
#include <omp.h>
#include <string.h>
#include <unistd.h>

enum {
    COLUMNS = 24,
    ROWS = 18,
    PIXELS = COLUMNS * ROWS,
    STRIDE = COLUMNS + 2,       /* of rows, where they are not dense */
    VALUES = 4 * STRIDE * ROWS, /* 2 frames of 2 channels */
    BYTES = VALUES * sizeof(float)
};

static char folder[64];

static char cache[] = "/tmp/skg-failing-cache-XXXXXX";

/* Removes what was kept. */
static void forget(void) {
    char path[400];
    DIR *files = opendir(cache);
    if (!files) return;
    for (struct dirent *one; (one = readdir(files));) {
        snprintf(path, sizeof path, "%s/%s", cache, one->d_name);
        if (one->d_name[0] != '.') unlink(path);
    }
    closedir(files);
}

static void set_up(void) {
    strcpy(cache, "/tmp/skg-failing-cache-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(cache));
    setenv("SKG_CACHE_DIR", cache, 1);
    strcpy(folder, "/tmp/skg-failing-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    failing_write_scenes(folder);
    json_set_alloc_funcs(malloc, free); /* of this program: those that may fail */
}

/* Removes results (or all files); returns how many files there were beside the inputs and whole results. */
static int clear(int all) {
    static const char *const inputs[] = {"scene.json", "body.json", "response.txt",
                                         "bone.obj",   "plate.obj", "sheet.stl"};
    static const char *const results[] = {
        "image.mha",      "image.tif",      "image.png",      "bone.ply",      "map.ply",   "fitted.json",
        "checkpoint",     "scan.mha",       "scan.tif",       "scan.h5",       "packed.h5", "geometry.csv",
        "scan-flats.mha", "scan-darks.mha", "scan-flats.tif", "scan-darks.tif"};
    const int result_count = sizeof results / sizeof *results, input_count = sizeof inputs / sizeof *inputs;
    int strange = 0;
    DIR *files = opendir(folder);
    for (struct dirent *one; (one = readdir(files));) {
        char path[400];
        int input = 0, result = 0;
        if (one->d_name[0] == '.' && (!one->d_name[1] || one->d_name[1] == '.')) continue;
        for (int n = 0; n < input_count; n++) input |= strcmp(one->d_name, inputs[n]) == 0;
        for (int n = 0; n < result_count; n++) result |= strcmp(one->d_name, results[n]) == 0;
        strange += !input && !result;
        snprintf(path, sizeof path, "%s/%s", folder, one->d_name);
        if (!input || all) unlink(path);
    }
    closedir(files);
    return strange;
}

static void tear_down(void) {
    forget();
    rmdir(cache);
    clear(1);
    rmdir(folder);
}

/* Objects that a run makes. */
typedef struct {
    const effects *with;
    shared_objects shared;
    skg_context *context;
    skg_setup *setup;
    skg_scene *scene;
    skg_motion *motion;
    skg_view view;
    skg_plan *plan;
    float *image, *lengths;
} run;

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        skg_status try_status = (call);                                                                      \
        if (try_status != SKG_OK) return try_status;                                                         \
    } while (0)

static skg_status plan_it(run *r) {
    static const double edges[3] = {1, 35, 60};
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_spot spot;
    TRY(skg_setup_scene_get(r->setup, &r->scene));
    TRY(skg_setup_spectrum_get(r->setup, &spectrum));
    skg_view_init(&r->view);
    TRY(skg_setup_view_get(r->setup, &r->view));
    skg_plan_options_init(&options);
    TRY(skg_setup_options_get(r->setup, &options));
    options.strategy = r->with->strategy;
    options.profile = 1;
    options.bands = r->with->bands;
    options.band_kev = edges;
    options.clip = r->with->clip;
    options.falloff = r->with->falloff;
    if (r->with->ratio) options.quantity = SKG_QUANTITY_ATTENUATION;
    skg_spot_init(&spot);
    if (r->with->spot.shape) {
        spot.shape = r->with->spot.shape;
        memcpy(spot.extent, r->with->spot.extent, sizeof spot.extent);
        spot.samples = r->with->spot.samples;
        if (!spot.samples)
            spot.tolerance = r->with->spot.tolerance, spot.samples_max = r->with->spot.samples_max;
        options.spot = &spot;
    }
    return skg_plan_create(r->context, r->scene, &r->view, spectrum, &options, &r->plan);
}

static skg_status prepare(run *r) {
    char path[128];
    int64_t settings = 0;
    while (r->with->settings[settings]) settings++;
    snprintf(path, sizeof path, "%s/%s", folder, r->with->file);
    if (r->with->shared)
        TRY(skg_context_create_cl(r->shared.context, r->shared.device, r->shared.queue, &r->context));
    else
        TRY(skg_context_create(r->with->device, &r->context));
    if (r->with->fresh) r->context->device->caches = 0; /* as if the driver had no cache */
    TRY(skg_setup_load(r->context, path, settings, r->with->settings, &r->setup));
    if (r->with->breathes) TRY(skg_motion_create(r->context, r->setup, &r->motion));
    return plan_it(r);
}

/* A 3D view of the scene. */
static skg_status draw_view(const run *r) {
    static uint8_t rgba[40 * 30 * 4];
    skg_look look;
    skg_look_init(&look);
    look.columns = 40, look.rows = 30;
    return skg_scene_picture(r->context, r->scene, &r->view, &look, rgba);
}

/* The parts that get positions from device memory: a thin one, and an open one with vertices that are merged till then. */
static const int64_t placed_parts[] = {1, 2};

/* Frames with positions from device memory: what happens to be in the buffer, within bounds. */
static skg_status place_and_draw(const run *r) {
    const float lowest[3] = {-9, -9, -9}, highest[3] = {9, 9, 9};
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    skg_output_init(&output);
    skg_frame_init(&frame);
    for (int n = 0; n < 2; n++) {
        cl_event done = NULL;
        const skg_status placed = skg_plan_positions_set_cl(r->plan, placed_parts[n], r->shared.buffer, 0,
                                                            lowest, highest, 0, NULL, &done);
        if (done) clReleaseEvent(done);
        TRY(placed);
    }
    output.buffer = r->shared.buffer;
    TRY(skg_plan_submit_cl(r->plan, 1, &frame, 1, &output, 0, NULL, NULL, &job));
    const skg_status status = skg_job_wait(&job);
    return status == SKG_RANGE ? SKG_OK : status;
}

/* Places and draws, then undoes the placing: the next frames have the positions of the host again. */
static skg_status draw_placed(const run *r) {
    const skg_status status = place_and_draw(r);
    for (int n = 0; n < 2; n++) {
        skg_part part;
        float *offsets;
        const double *origin;
        skg_part_init(&part);
        skg_scene_part_get(r->scene, placed_parts[n], &part);
        skg_mesh_offsets_get(part.mesh, &offsets, &origin);
        skg_mesh_offsets_moved(part.mesh);
    }
    return status;
}

/* Two frames at once; breathing, of two times. */
static skg_status draw(run *r) {
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    if (r->motion) {
        TRY(skg_motion_pose_at_time(r->motion, 0.7));
        TRY(skg_motion_fill(r->motion, &frame));
    }
    const skg_frame frames[2] = {frame, frame};
    skg_output_init(&output);
    output.data = r->image;
    if (r->with->strided) output.row_stride = STRIDE;
    if (r->with->shared) output.buffer = r->shared.buffer;
    if (r->with->shared)
        TRY(skg_plan_submit_cl(r->plan, 2, frames, 1, &output, 1, &r->shared.start, NULL, &job));
    else
        TRY(skg_plan_submit(r->plan, 2, frames, 1, &output, &job));
    if (skg_work_count() != 1) return SKG_ERR_INTERNAL; /* Check would allocate */
    TRY(skg_job_wait(&job));
    if (r->with->shared) shared_read(&r->shared, 2 * PIXELS * sizeof *r->image, r->image);
    output.row_stride = 0;
    output.buffer = NULL;
    output.data = r->lengths;
    output.kind = SKG_OUTPUT_LENGTHS;
    TRY(skg_plan_submit(r->plan, 1, NULL, 1, &output, &job));
    int32_t done = 0;
    const skg_status asked = skg_job_test(job, &done);
    TRY(skg_job_wait(&job)); /* the job is released, whatever became of the question */
    if (asked == SKG_OK && r->with->shared) TRY(draw_view(r));
    return asked == SKG_OK && r->with->shared ? draw_placed(r) : asked;
}

/* And what the run has beside it: a projection of a scan, scatter, variances or derivatives take the place of the lengths. */
static skg_status draw_all(run *r) {
    TRY(draw(r));
    if (r->with->varies) TRY(failing_noise(r->plan, r->lengths));
    if (r->with->series) TRY(failing_series(r->plan, &r->view, r->image, r->lengths));
    if (r->with->derives) TRY(failing_gradient(r->plan, r->scene, &r->view, r->shared.buffer, r->lengths));
    return r->with->scans ? failing_scan(folder, r->plan, r->scene, &r->view, r->lengths) : SKG_OK;
}

/* A part's distance from itself, and a map of it. */
static skg_status save_map(const skg_mesh *mesh) {
    char path[128];
    int64_t vertices = 0, triangles = 0;
    static double positions[3 * 4096], distances[4096];
    skg_distance distance;
    skg_distance_options options;
    skg_distance_init(&distance);
    skg_distance_options_init(&options);
    TRY(skg_distance_measure(mesh, mesh, NULL, &distance));
    options.sampling = SKG_DISTANCE_VERTICES;
    TRY(skg_distance_measure(mesh, mesh, &options, &distance));
    TRY(skg_mesh_count(mesh, &vertices, &triangles));
    if (vertices > 4096) return SKG_ERR_ARGUMENT; /* Check would allocate */
    TRY(skg_mesh_positions_get(mesh, positions, 0));
    TRY(skg_distance_of_points(mesh, vertices, positions, distances));
    snprintf(path, sizeof path, "%s/map.ply", folder);
    return skg_distance_map_save(mesh, distances, 1, path);
}

static skg_status save(const run *r) {
    static const char *const names[] = {"image.mha", "image.tif", "image.png"};
    char path[128];
    skg_picture picture;
    skg_part part;
    skg_picture_init(&picture);
    picture.columns = COLUMNS;
    picture.rows = ROWS;
    picture.channels = 1;
    picture.data = r->image;
    picture.view = &r->view;
    picture.flat_field = 1;
    for (int n = 0; n < 3; n++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[n]);
        TRY(skg_picture_save(&picture, path));
    }
    snprintf(path, sizeof path, "%s/bone.ply", folder);
    skg_part_init(&part);
    TRY(skg_scene_part_get(r->scene, 1, &part));
    TRY(skg_mesh_save(part.mesh, path));
    return save_map(part.mesh);
}

/* A few generations of both methods of a fit, with a checkpoint between them. */
static skg_status fit_with(const run *r, skg_fit *fit) {
    char paths[2][128];
    skg_part part;
    skg_part_init(&part);
    snprintf(paths[0], sizeof paths[0], "%s/checkpoint", folder);
    snprintf(paths[1], sizeof paths[1], "%s/fitted.json", folder);
    TRY(skg_fit_parameters_choose(fit, "tendon,diaphragm,links"));
    TRY(skg_scene_part_get(r->scene, 1, &part));
    TRY(skg_fit_target_add(fit, 1, 0.25, part.mesh));
    TRY(skg_fit_target_add(fit, 1, 0.5, part.mesh));
    TRY(skg_fit_checkpoint_save(fit, paths[0]));
    TRY(skg_fit_checkpoint_load(fit, paths[0]));
    TRY(skg_fit_step(fit, NULL));
    TRY(skg_fit_step(fit, NULL));
    TRY(skg_fit_finish(fit));
    return skg_fit_scene_save(fit, paths[1]);
}

/* With one thread, so that the n-th call is the same one in every run. */
static skg_status fit_body(const run *r) {
    const int threads = omp_get_max_threads();
    skg_status status = SKG_OK;
    omp_set_num_threads(1);
    for (int32_t method = SKG_FIT_METHOD_CMA; method <= SKG_FIT_METHOD_DE && status == SKG_OK; method++) {
        skg_fit_options options;
        skg_fit *fit = NULL;
        skg_fit_options_init(&options);
        options.method = method;
        status = skg_fit_create(r->context, r->setup, &options, &fit);
        if (status == SKG_OK) status = fit_with(r, fit);
        skg_fit_release(&fit);
    }
    omp_set_num_threads(threads);
    return status;
}

static void check_sentence(skg_status status, const char *what) {
    ck_assert_msg(status < 0, "%s failed, and the answer was %s", what, skg_status_name(status));
    ck_assert_msg(status != SKG_ERR_INTERNAL, "%s failed: %s", what, skg_last_error());
    ck_assert_msg(*skg_last_error() != '\0', "%s failed, and nothing was said", what);
}

/* One run in which call `at` fails (-1: none). Its image and lengths stay in the arrays when it is done. */
static skg_status run_once(int kind, const effects *with, int64_t at, float *image, float *lengths,
                           int64_t *calls) {
    run r = {.with = with};
    if (with->fresh) forget();
    /* Blocks of their own: what is written to them too late is seen by AddressSanitizer. */
    r.image = calloc(VALUES, sizeof *r.image);
    r.lengths = calloc(PIXELS, sizeof *r.lengths);
    if (with->shared) shared_make(BYTES, &r.shared);
    failing_start(kind, at);
    skg_status status = prepare(&r);
    if (status == SKG_OK) status = draw_all(&r);
    if (status == SKG_OK) status = save(&r);
    if (status == SKG_OK && with->breathes) status = fit_body(&r);
    *calls = failing_stop();
    if (status != SKG_OK) check_sentence(status, failing_hit());
    if (r.plan) { /* again, and nothing fails */
        memset(r.image, 0xff, VALUES * sizeof *r.image);
        const skg_status again = draw_all(&r);
        ck_assert_msg(again == SKG_OK, "after a failing %s (call %lld) the plan does not recover: %s",
                      failing_hit(), (long long)at, skg_last_error());
        memcpy(image, r.image, VALUES * sizeof *image);
        memcpy(lengths, r.lengths, PIXELS * sizeof *lengths);
    }
    ck_assert_int_eq(skg_work_count(), 0);
    free(r.image);
    free(r.lengths);
    skg_plan_release(&r.plan);
    skg_motion_release(&r.motion);
    skg_setup_release(&r.setup);
    skg_context_release(&r.context);
    shared_free(&r.shared);
    return status;
}

static int64_t fail_everywhere(int kind, const effects *with) {
    static float image[VALUES], lengths[PIXELS], got[VALUES], got_lengths[PIXELS];
    int64_t calls = 0, tried = 0, unused = 0, survived = 0;
    /* Objects that are kept for good are made in the first runs: tests, then programs that were used twice. */
    for (int k = 0; k < 4; k++) {
        ck_skg(run_once(kind, with, -1, image, lengths, &calls));
        ck_assert_int_eq(clear(0), 0); /* a scan that is there would be continued */
    }
    const int64_t blocks = failing_live_blocks(), objects = failing_live_objects();
    for (int64_t at = 0; at < calls; at++) {
        if (!failing_is_new(at)) continue;
        memcpy(got, image, sizeof got);
        memcpy(got_lengths, lengths, sizeof got_lengths);
        const skg_status status = run_once(kind, with, at, got, got_lengths, &unused);
        const char *name = failing_hit();
        tried++;
        survived += status == SKG_OK;
        ck_assert_msg(memcmp(got, image, sizeof got) == 0, "%s, call %lld: another image", name,
                      (long long)at);
        ck_assert_msg(memcmp(got_lengths, lengths, sizeof got_lengths) == 0, "%s, call %lld: other lengths",
                      name, (long long)at);
        ck_assert_msg(failing_live_blocks() == blocks, "%s, call %lld (%s): %lld blocks leak", name,
                      (long long)at, skg_last_error(), (long long)(failing_live_blocks() - blocks));
        ck_assert_msg(failing_live_objects() == objects, "%s, call %lld (%s): %lld OpenCL objects leak", name,
                      (long long)at, skg_last_error(), (long long)(failing_live_objects() - objects));
        ck_assert_msg(clear(0) == 0, "%s, call %lld: a file was left", name, (long long)at);
    }
    printf("%lld calls, %lld places tried, %lld of them to no harm\n", (long long)calls, (long long)tried,
           (long long)survived);
    fflush(stdout);
    return tried;
}

/* Places of all runs, each made to fail once. Where they are goes into the file $SKG_SITES: failing.sh compares
 * them with all places of the library that make such a call. */
static void fail_all(int kind) {
    const char *sites = getenv("SKG_SITES");
    for (int n = 0; n < FAILING_RUNS; n++) fail_everywhere(kind, &failing_runs[n]);
    if (sites) failing_write_sites(sites);
}

START_TEST(allocations) {
    fail_all(FAIL_ALLOCATION);
}
END_TEST

START_TEST(opencl_calls) {
    fail_all(FAIL_OPENCL);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_set_timeout(tests, 1800);
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, allocations);
    tcase_add_test(tests, opencl_calls);
}

SKG_SUITE_MAIN("failing", add_tests)
