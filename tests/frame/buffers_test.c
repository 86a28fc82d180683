/* OpenCL objects of the caller: path lengths in its buffers, and two contexts in two threads. */
#include "suite.h"

#include <skiagraph/opencl.h>
#include <skiagraph/skiagraph.h>

#include <pthread.h>
#include <string.h>

enum { SIDE = 40, PIXELS = SIDE * SIDE, FRAMES = 6 };

/* A caller with objects of its own, and a cube of 20 mm with a ball inside. */
typedef struct {
    cl_context cl;
    cl_command_queue queue;
    cl_mem buffer;
    skg_context *context;
    skg_scene *scene;
    skg_plan *plan;
    skg_view view;
} caller;

static void make_cl(caller *c, size_t bytes) {
    cl_platform_id platforms[8];
    cl_device_id device = NULL;
    cl_uint count = 0;
    cl_int code = CL_DEVICE_NOT_FOUND;
    ck_assert_int_eq(clGetPlatformIDs(8, platforms, &count), CL_SUCCESS);
    for (cl_uint n = 0; n < count && code != CL_SUCCESS; n++)
        code = clGetDeviceIDs(platforms[n], CL_DEVICE_TYPE_ALL, 1, &device, NULL);
    ck_assert_int_eq(code, CL_SUCCESS);
    c->cl = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    c->queue = clCreateCommandQueue(c->cl, device, 0, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    c->buffer = clCreateBuffer(c->cl, CL_MEM_READ_WRITE, bytes, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    ck_skg(skg_context_create_cl(c->cl, device, c->queue, &c->context));
}

static void add_part(caller *c, const char *label, skg_mesh *mesh, double mu, int64_t inside) {
    skg_part part;
    skg_material *material = NULL;
    ck_skg(skg_material_create_mu(label, mu, &material));
    skg_part_init(&part);
    part.label = label;
    part.mesh = mesh;
    part.material = material;
    part.inside = inside;
    ck_skg(skg_scene_add(c->scene, &part, NULL));
    skg_material_release(&material);
    skg_mesh_release(&mesh);
}

static void open_caller(caller *c, size_t bytes) {
    skg_mesh *cube = NULL, *ball = NULL;
    skg_spectrum *beam = NULL;
    *c = (caller){0};
    make_cl(c, bytes);
    ck_skg(skg_scene_create(c->context, &c->scene));
    ck_skg(skg_mesh_create_cube(20, &cube));
    ck_skg(skg_mesh_create_sphere(6, 24, &ball));
    add_part(c, "cube", cube, 0.2, -1);
    add_part(c, "ball", ball, 0.5, 0);
    skg_view_init(&c->view);
    c->view.columns = c->view.rows = SIDE;
    c->view.source[2] = -500;
    c->view.centre[2] = 100;
    c->view.column_step[0] = c->view.row_step[1] = 1;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(c->context, c->scene, &c->view, beam, NULL, &c->plan));
    skg_spectrum_release(&beam);
}

static void close_caller(caller *c) {
    skg_plan_release(&c->plan);
    skg_scene_release(&c->scene);
    skg_context_release(&c->context);
    clReleaseMemObject(c->buffer);
    clReleaseCommandQueue(c->queue);
    clReleaseContext(c->cl);
}

static skg_output output_of(void *data) {
    skg_output output;
    skg_output_init(&output);
    output.data = data;
    return output;
}

/* The lengths in a buffer are those in host memory, behind an offset, after the caller's event. */
START_TEST(lengths_in_device_memory) {
    enum { OFFSET = 32 };
    static float expected[PIXELS], got[OFFSET / 4 + PIXELS];
    caller c;
    open_caller(&c, sizeof got);
    cl_int code = CL_SUCCESS, state = CL_QUEUED;
    cl_event start = clCreateUserEvent(c.cl, &code), done = NULL;
    skg_job *job = NULL;
    skg_output output = output_of(expected);
    for (int32_t kind = SKG_LENGTHS_NET; kind <= SKG_LENGTHS_SURFACE; kind++) {
        output = output_of(expected);
        ck_skg(skg_plan_lengths(c.plan, 0, kind, 1, NULL, &output, &job));
        ck_skg(skg_job_wait(&job));
        output = output_of(NULL);
        ck_skg(
            skg_plan_lengths_cl(c.plan, 0, kind, 1, NULL, &output, c.buffer, OFFSET, 1, &start, &done, &job));
        if (kind == SKG_LENGTHS_NET) { /* nothing was waited for: the event is still open */
            ck_assert_int_eq(
                clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, NULL),
                CL_SUCCESS);
            ck_assert_int_gt(state, CL_COMPLETE);
            ck_assert_int_eq(clSetUserEventStatus(start, CL_COMPLETE), CL_SUCCESS);
        }
        ck_assert_int_eq(clEnqueueReadBuffer(c.queue, c.buffer, CL_TRUE, 0, sizeof got, got, 1, &done, NULL),
                         CL_SUCCESS);
        ck_assert_mem_eq(got + OFFSET / 4, expected, sizeof expected);
        ck_assert(expected[PIXELS / 2 + SIDE / 2] > 0);
        ck_skg(skg_job_wait(&job));
        clReleaseEvent(done);
    }
    clReleaseEvent(start);
    ck_skg_fails(skg_plan_lengths_cl(c.plan, 2, 0, 1, NULL, &output, c.buffer, 0, 0, NULL, NULL, &job),
                 SKG_ERR_ARGUMENT, "skg_plan_lengths_cl: part 2 of 2");
    ck_skg_fails(skg_plan_lengths_cl(c.plan, 0, 7, 1, NULL, &output, c.buffer, 0, 0, NULL, NULL, &job),
                 SKG_ERR_ARGUMENT, "kind 7");
    ck_skg_fails(skg_plan_lengths_cl(c.plan, 0, 0, 1, NULL, &output, NULL, 0, 0, NULL, NULL, &job),
                 SKG_ERR_ARGUMENT, "no buffer");
    ck_skg_fails(skg_plan_lengths_cl(c.plan, 0, 0, 1, NULL, &output, c.buffer, 0, 1, NULL, NULL, &job),
                 SKG_ERR_ARGUMENT, "no list");
    ck_skg_fails(
        skg_plan_lengths_cl(c.plan, 0, 0, 1, NULL, &output, c.buffer, OFFSET + 4, 0, NULL, NULL, &job),
        SKG_ERR_ARGUMENT, "the buffer at");
    close_caller(&c);
}
END_TEST

typedef struct {
    double shift;
    float images[FRAMES][PIXELS];
} worker;

/* Images of a moving source, each in the caller's buffer. Runs in a thread. */
static void *work(void *user) {
    worker *w = user;
    caller c;
    open_caller(&c, sizeof w->images);
    skg_view views[FRAMES];
    skg_frame frames[FRAMES];
    skg_job *job = NULL;
    const skg_output output = output_of(NULL);
    for (int n = 0; n < FRAMES; n++) {
        views[n] = c.view;
        views[n].source[0] = w->shift + 10 * n;
        skg_frame_init(&frames[n]);
        frames[n].view = &views[n];
    }
    ck_skg(skg_plan_submit_cl(c.plan, FRAMES, frames, &output, c.buffer, 0, 0, NULL, NULL, &job));
    ck_assert_int_eq(
        clEnqueueReadBuffer(c.queue, c.buffer, CL_TRUE, 0, sizeof w->images, w->images, 0, NULL, NULL),
        CL_SUCCESS);
    ck_skg(skg_job_wait(&job));
    close_caller(&c);
    return NULL;
}

START_TEST(two_contexts_in_two_threads) {
    static worker alone[2] = {{.shift = 0}, {.shift = 25}}, together[2] = {{.shift = 0}, {.shift = 25}};
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) work(&alone[k]);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(pthread_create(&threads[k], NULL, work, &together[k]), 0);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(pthread_join(threads[k], NULL), 0);
    for (int k = 0; k < 2; k++) ck_assert_mem_eq(alone[k].images, together[k].images, sizeof alone[k].images);
    ck_assert(memcmp(alone[0].images, alone[1].images, sizeof alone[0].images) != 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, lengths_in_device_memory);
    tcase_add_test(tests, two_contexts_in_two_threads);
}

SKG_SUITE_MAIN("buffers", add_tests)
