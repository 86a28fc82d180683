/* A full run (device, scene file, plan, image, lengths, files) in which one call fails, for each place in the
 * program that makes such a call. The run has to fail with a sentence or to give the right image; nothing may
 * leak, no file may be half there, and the same plan has to work when asked again. */
#include "device/device.h"
#include "hard/failing_calls.h"
#include "hard/failing_scan.h"
#include "hard/failing_shared.h"
#include "suite.h"

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

static void write_text(const char *name, const char *text) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
}

/* A closed part, one from a file, an open one, a tube, a response, the world, a scan. */
static const char scene_text[] =
    "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"PointSource\",\n"
    " \"Beam\": {\"kVp\": 60, \"Filter\": [[\"Al\", 2.5, \"mm\"]], \"MaxNumberOfEnergyBins\": 6}},\n"
    " \"Detector\": {\"Position\": [0, 10, 0, \"cm\"], \"UpVector\": [0, 0, -1],\n"
    "  \"NumberOfPixels\": [24, 18], \"Size\": [12, 9, \"cm\"],\n"
    "  \"EnergyResponse\": {\"File\": \"response.txt\", \"Unit\": \"keV\"}},\n"
    " \"Samples\": [{\"Label\": \"skin\", \"Cube\": [40, \"mm\"], \"Material\": [\"HU\", 20], \"Type\": \"outer\"},\n"
    " {\"Label\": \"bone\", \"Path\": \"bone.obj\", \"Unit\": \"mm\", \"Material\": [\"Compound\", \"Ca5(PO4)3OH\"],\n"
    "  \"Density\": 1.5, \"Transform\": [[\"Rotation\", 30, 0, 0, 1]]},\n"
    " {\"Label\": \"sheet\", \"Path\": \"sheet.stl\", \"Unit\": \"mm\", \"Material\": [\"Element\", \"Cu\"]}],\n"
    " \"World\": \"Air\", \"Tolerance\": 1e-3}\n";
/* Enough of a body that breathes. */
static const char body_text[] =
    "{\"Source\": {\"Position\": [0, -860, -20, \"mm\"], \"Shape\": \"PointSource\",\n"
    "  \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},\n"
    " \"Detector\": {\"Position\": [0, 140, -20, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "  \"NumberOfPixels\": [24, 18], \"Size\": [480, 360, \"mm\"]},\n \"Samples\": [\n"
    "  {\"Label\": \"lung right\", \"Sphere\": [8, 40, \"mm\"], \"Material\": [\"HU\", -700]},\n"
    "  {\"Label\": \"flat\", \"Sphere\": [9, 60, \"mm\"], \"Material\": [\"mu\", 0.2]},\n"
    "  {\"Label\": \"inside\", \"Sphere\": [6, 5, \"mm\"], \"Material\": [\"mu\", 0.3], \"Parent\": \"lung "
    "right\"}],\n"
    " \"Breathing\": {\"Waveform\": [1, 0.2, 0, 0.2], \"Hysteresis\": 0.5, \"Relaxation\": 2,\n"
    "  \"Organs\": {\"flat\": {\"As\": \"diaphragm\", \"Tissue\": [0.6, 1.2, 0.2]}},\n"
    "  \"Events\": [{\"Hold\": [1, 2]}, {\"Contrast\": \"inside\", \"Share\": [[0, 0.5]]}]}}\n";
static const char response_text[] = "1 1\n60 58\n200 150\n";
static const char bone_text[] = "v -5 -5 -5\nv 8 0 0\nv 0 8 0\nv 0 0 8\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
/* So thin that its vertices keep what rounding has lost. */
static const char plate_text[] =
    "v -5 -5 0\nv 8 0 0\nv 0 8 0\nv 0 0 0.01\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
static const char sheet_text[] =
    "solid s\nfacet normal 0 0 0\nouter loop\nvertex 5 0 5\nvertex 5 9 5\nvertex 9 0 5\n"
    "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 5 9 5\nvertex 9 9 5\nvertex 9 0 5\n"
    "endloop\nendfacet\nendsolid s\n";

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
    write_text("scene.json", scene_text);
    write_text("body.json", body_text);
    write_text("response.txt", response_text);
    write_text("bone.obj", bone_text);
    write_text("plate.obj", plate_text);
    write_text("sheet.stl", sheet_text);
    json_set_alloc_funcs(malloc, free); /* of this program: those that may fail */
}

/* Removes results (or all files); returns how many files there were beside the inputs and whole results. */
static int clear(int all) {
    static const char *const inputs[] = {"scene.json", "body.json", "response.txt",
                                         "bone.obj",   "plate.obj", "sheet.stl"};
    static const char *const results[] = {"image.mha", "image.tif",   "image.png",  "bone.ply",
                                          "map.ply",   "fitted.json", "checkpoint", "scan.mha",
                                          "scan.tif",  "scan.h5",     "packed.h5",  "geometry.csv"};
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

/* The effects, spread over few runs; settings change the scene file. */
typedef struct {
    const char *file, *settings[8]; /* NULL: no more */
    int32_t strategy;
    skg_spot spot; /* shape 0: the scene's */
    int32_t bands, clip, falloff, breathes;
    int32_t strided; /* the image's rows are not dense */
    int32_t shared;  /* on OpenCL objects of the caller, into the caller's buffer */
    int32_t scans;   /* a scan into files, beside the images */
    const char *device;
    int32_t fresh; /* nothing was kept: the device is tested, and programs are compiled and kept */
} effects;

static const effects runs[] = {
    /* nothing but the test of the device and the first image of a machine */
    {.file = "scene.json", .settings = {"Tolerance=0"}, .strategy = SKG_STRATEGY_COPIES, .fresh = 1},
    /* compression, neighbours' repair, world, response, source samples, tiles */
    {.file = "scene.json",
     .strategy = SKG_STRATEGY_TILES,
     .spot = {.shape = SKG_SPOT_RECTANGLE, .extent = {1, 1, 0}, .samples = 4}},
    /* exact repair, priority, two line spread functions, noise, falloff, copies, one thread */
    {.file = "scene.json",
     .settings = {"Repair=exact", "Samples.bone.Priority=2", "Detector.LSF=[[0.2,1,0.2],[1,2,1]]",
                  "Noise={\"Quantum\":true,\"Electronic\":[2,\"keV\"],\"Step\":[0.5,\"keV\"],\"Swank\":0.9}"},
     .strategy = SKG_STRATEGY_COPIES,
     .falloff = 1,
     .device = "threads=1"},
    /* double, every bin, point spread function, pixels of four rays, bands, clipping, atomics, rows with gaps */
    {.file = "scene.json",
     .settings = {"Precision=double", "Tolerance=0", "Detector.PSF=[[0,1,0],[1,4,1],[0,1,0]]",
                  "Detector.Oversampling=2", "Samples.bone.Parent=skin"},
     .strategy = SKG_STRATEGY_ATOMICS,
     .bands = 2,
     .clip = 1,
     .strided = 1},
    /* half, which knows closed meshes only; four rays of a pixel in one pass */
    {.file = "scene.json",
     .settings = {"Precision=half", "World=Vacuum", "Samples.sheet.Path=bone.obj", "Detector.Oversampling=2",
                  "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]"}},
    /* samples of the source as their tolerance asks for; a table of attenuation; the caller's OpenCL objects; a thin mesh;
     * vertices of an open mesh that part */
    {.file = "scene.json",
     .settings = {"Samples.skin.Material=[\"Table\",\"response.txt\",\"keV\"]",
                  "Samples.bone.Path=plate.obj"},
     .strategy = SKG_STRATEGY_COPIES,
     .spot = {.shape = SKG_SPOT_DISC, .extent = {0.2, 0, 0}, .tolerance = 0.2, .samples_max = 8},
     .shared = 1},
    /* samples that are drawn together, because meshes are closed */
    {.file = "scene.json",
     .settings = {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]"},
     .strategy = SKG_STRATEGY_COPIES,
     .spot = {.shape = SKG_SPOT_RECTANGLE, .extent = {1, 1, 0}, .samples = 4}},
    /* scattered photons, with their noise */
    {.file = "scene.json",
     .settings = {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]",
                  "World=Vacuum", "Tolerance=0",
                  "Scatter={\"Histories\":32,\"Detector\":[4,4],\"Voxel\":[5,\"mm\"]}", "Noise=true"},
     .strategy = SKG_STRATEGY_COPIES},
    {.file = "body.json", .breathes = 1},
    {.file = "scene.json",
     .settings = {"Tolerance=0", "World=Vacuum"},
     .strategy = SKG_STRATEGY_COPIES,
     .scans = 1}};
enum { RUNS = sizeof runs / sizeof *runs };

/* What a run makes. */
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

/* The same; the next frames have the positions of the host again. */
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
        TRY(skg_plan_submit(r->plan, 2, frames, &output, &job));
    if (skg_work_count() != 1) return SKG_ERR_INTERNAL; /* Check would allocate */
    TRY(skg_job_wait(&job));
    if (r->with->shared) shared_read(&r->shared, 2 * PIXELS * sizeof *r->image, r->image);
    output.row_stride = 0;
    output.buffer = NULL;
    output.data = r->lengths;
    output.kind = SKG_OUTPUT_LENGTHS;
    TRY(skg_plan_submit(r->plan, 1, NULL, &output, &job));
    int32_t done = 0;
    const skg_status asked = skg_job_test(job, &done);
    TRY(skg_job_wait(&job)); /* the job is released, whatever became of the question */
    if (asked == SKG_OK && r->with->shared) TRY(draw_view(r));
    return asked == SKG_OK && r->with->shared ? draw_placed(r) : asked;
}

/* And the scan where the run has one, of which a projection takes the place of the lengths. */
static skg_status draw_all(run *r) {
    TRY(draw(r));
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
        if (status == SKG_ERR_UNSUPPORTED) status = SKG_OK; /* a build without LAPACKE */
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
    /* What is kept for good is made in the first ones: tests, then programs that were used twice. */
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
    for (int n = 0; n < RUNS; n++) fail_everywhere(kind, &runs[n]);
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
