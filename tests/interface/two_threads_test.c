/* Two threads with a context each, from the start of OpenCL to images and files: the same bits as one thread alone, from scenes of their
 * own and from one that they share. This is also what ThreadSanitizer watches (preset tsan). */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <pthread.h>
#include <string.h>

enum { THREADS = 2, SIDE = 48, PIXELS = SIDE * SIDE, FRAMES = 6 };

typedef struct {
    pthread_barrier_t *together;
    skg_material *shared; /* never changes, so that threads may share it */
    skg_scene *scene;     /* nobody changes it, nor its meshes; NULL: the worker makes its own */
    skg_status status;
    char message[256];
    float images[FRAMES][PIXELS];
    float lengths[PIXELS];
    int32_t sentences;
} worker;

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        skg_status try_status = (call);                                                                      \
        if (try_status != SKG_OK) return try_status;                                                         \
    } while (0)

static void hear(int32_t level, const char *sentence, void *user) {
    worker *w = user;
    (void)level;
    (void)sentence;
    w->sentences++;
}

static void look_from(skg_view *view, double z) {
    skg_view_init(view);
    view->columns = view->rows = SIDE;
    view->source[2] = -1000;
    view->centre[2] = z;
    view->column_step[0] = view->row_step[1] = 3;
}

static skg_status add_part(skg_scene *scene, skg_mesh *mesh, skg_material *material, int64_t inside) {
    skg_part part;
    int64_t id = -1;
    skg_part_init(&part);
    part.mesh = mesh;
    part.material = material;
    part.label = inside < 0 ? "outer" : "inner";
    part.inside = inside;
    if (inside >= 0) part.pose[3] = 5;
    return skg_scene_part_add(scene, &part, &id);
}

static skg_status make_scene(skg_material *shared, skg_scene *scene) {
    skg_mesh *outer = NULL, *inner = NULL;
    skg_material *bone = NULL;
    skg_status status = skg_mesh_create_sphere(50, 40, &outer);
    if (status == SKG_OK) status = skg_mesh_create_sphere(20, 24, &inner);
    if (status == SKG_OK) status = skg_material_create_mu("bone", 0.5, &bone);
    if (status == SKG_OK) status = add_part(scene, outer, shared, -1);
    if (status == SKG_OK) status = add_part(scene, inner, bone, 0);
    skg_material_release(&bone);
    skg_mesh_release(&inner);
    skg_mesh_release(&outer);
    return status;
}

static skg_status take_images(skg_plan *plan, worker *w) {
    skg_output output;
    skg_job *job = NULL;
    skg_frame frames[FRAMES];
    skg_output_init(&output);
    output.data = w->images;
    for (int n = 0; n < FRAMES; n++) {
        skg_frame_init(&frames[n]);
        frames[n].index = n;
    }
    TRY(skg_plan_submit(plan, FRAMES, frames, 1, &output, &job));
    TRY(skg_job_wait(&job));
    output.data = w->lengths;
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = 1;
    TRY(skg_plan_submit(plan, 1, frames, 1, &output, &job));
    return skg_job_wait(&job);
}

static skg_status use_plan(skg_context *context, skg_scene *scene, worker *w) {
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_view view;
    look_from(&view, 200);
    skg_plan_options_init(&options);
    options.noise = 1;
    TRY(skg_spectrum_create_mono(60, 1000, &beam));
    skg_status status = skg_plan_create(context, scene, &view, beam, &options, &plan);
    skg_spectrum_release(&beam);
    if (status == SKG_OK) status = take_images(plan, w);
    skg_plan_release(&plan);
    return status;
}

static skg_status work(worker *w) {
    skg_context *context = NULL;
    skg_scene *scene = NULL;
    TRY(skg_context_create(NULL, &context));
    skg_status status = skg_context_log_set(context, hear, w);
    if (w->scene) {
        if (status == SKG_OK) status = use_plan(context, w->scene, w);
    } else {
        if (status == SKG_OK) status = skg_scene_create(context, &scene);
        if (status == SKG_OK) status = make_scene(w->shared, scene);
        if (status == SKG_OK) status = use_plan(context, scene, w);
    }
    skg_scene_release(&scene);
    skg_context_release(&context);
    return status;
}

static void *run(void *argument) {
    worker *w = argument;
    if (w->together) pthread_barrier_wait(w->together);
    w->status = work(w);
    snprintf(w->message, sizeof w->message, "%s", skg_last_error());
    return NULL;
}

START_TEST(the_same_bits_as_alone) {
    static worker workers[THREADS], alone;
    pthread_barrier_t together;
    pthread_t threads[THREADS];
    skg_material *shared = NULL;
    skg_scene *scene = NULL;
    ck_skg(skg_material_create_mu("soft", 0.2, &shared));
    if (_i == 1) {
        ck_skg(skg_scene_create(NULL, &scene));
        ck_skg(make_scene(shared, scene));
    }
    pthread_barrier_init(&together, NULL, THREADS);
    for (int n = 0; n < THREADS; n++) {
        workers[n] = (worker){.together = &together, .shared = shared, .scene = scene};
        ck_assert_int_eq(pthread_create(&threads[n], NULL, run, &workers[n]), 0);
    }
    for (int n = 0; n < THREADS; n++) ck_assert_int_eq(pthread_join(threads[n], NULL), 0);
    pthread_barrier_destroy(&together);
    alone = (worker){.shared = shared};
    run(&alone);
    ck_assert_msg(alone.status == SKG_OK, "%s", alone.message);
    for (int n = 0; n < THREADS; n++) {
        ck_assert_msg(workers[n].status == SKG_OK, "%s", workers[n].message);
        ck_assert_int_eq(memcmp(workers[n].images, alone.images, sizeof alone.images), 0);
        ck_assert_int_eq(memcmp(workers[n].lengths, alone.lengths, sizeof alone.lengths), 0);
    }
    ck_assert(alone.lengths[PIXELS / 2 + SIDE / 2] > 0);
    ck_assert_mem_ne(alone.images[0], alone.images[1], sizeof alone.images[0]); /* noise */
    skg_scene_release(&scene);
    skg_material_release(&shared);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, the_same_bits_as_alone, 0, 2);
}

SKG_SUITE_MAIN("two threads", add_tests)
