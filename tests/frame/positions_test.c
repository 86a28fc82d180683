/* Positions of vertices from the caller's device memory: the same image as from host memory, behind the caller's events,
 * within bounds that the device watches. */
#include "caller.h"
#include "suite.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LIMIT = 4096, CUBE = 0, BALL = 1, FRAMES = 4 };

/* Positions of a part's mesh, mm from its origin, and their bounds. */
typedef struct {
    skg_mesh *mesh; /* of the scene */
    int64_t count;
    float xyz[3 * LIMIT], lowest[3], highest[3];
} shape;

static void find_bounds(shape *s) {
    for (int k = 0; k < 3; k++) s->lowest[k] = INFINITY, s->highest[k] = -INFINITY;
    for (int64_t i = 0; i < 3 * s->count; i++) {
        s->lowest[i % 3] = fminf(s->lowest[i % 3], s->xyz[i]);
        s->highest[i % 3] = fmaxf(s->highest[i % 3], s->xyz[i]);
    }
}

/* The part's mesh, stretched and sheared by an amount. */
static void bend(const caller *c, int64_t part, float amount, shape *s) {
    skg_part found;
    float *offsets = NULL;
    const double *origin = NULL;
    skg_part_init(&found);
    ck_skg(skg_scene_part_get(c->scene, part, &found));
    s->mesh = found.mesh;
    ck_skg(skg_mesh_count(s->mesh, &s->count, NULL));
    ck_assert_int_le(s->count, LIMIT);
    ck_skg(skg_mesh_offsets_get(s->mesh, &offsets, &origin));
    for (int64_t v = 0; v < s->count; v++) {
        const float *from = offsets + 3 * v;
        float *to = s->xyz + 3 * v;
        to[0] = from[0] * (1 + amount) + amount * from[1];
        to[1] = from[1] - amount * from[2];
        to[2] = from[2] * (1 - amount) + amount;
    }
    find_bounds(s);
}

static void send(const caller *c, const shape *s, size_t offset) {
    ck_assert_int_eq(clEnqueueWriteBuffer(c->queue, c->buffer, CL_TRUE, offset,
                                          (size_t)s->count * 3 * sizeof(float), s->xyz, 0, NULL, NULL),
                     CL_SUCCESS);
}

static skg_status place(const caller *c, int64_t part, const shape *s, size_t offset) {
    return skg_plan_positions_set_cl(c->plan, part, c->buffer, (int64_t)offset, s->lowest, s->highest, 0,
                                     NULL, NULL);
}

/* Puts the positions into the mesh on the host. */
static void put(const shape *s) {
    float *offsets = NULL;
    const double *origin = NULL;
    ck_skg(skg_mesh_offsets_get(s->mesh, &offsets, &origin));
    memcpy(offsets, s->xyz, (size_t)s->count * 3 * sizeof(float));
    ck_skg(skg_mesh_offsets_moved(s->mesh));
}

static skg_status image(const caller *c, float *pixels) {
    const skg_output output = output_of(pixels);
    return skg_plan_image(c->plan, &output);
}

/* The image of a plan that has the positions in its meshes on the host. */
static void expect(const shape *cube, const shape *ball, const skg_plan_options *options, float *pixels) {
    caller host;
    open_caller(&host, 16, options);
    shape there;
    const shape *const from[] = {cube, ball};
    for (int64_t part = CUBE; part <= BALL; part++) {
        if (!from[part]) continue;
        bend(&host, part, 0, &there);
        memcpy(there.xyz, from[part]->xyz, sizeof there.xyz);
        put(&there);
    }
    ck_skg(image(&host, pixels));
    close_caller(&host);
}

static void compare_with_host(const skg_plan_options *options) {
    enum { OFFSET = 64 };
    static float before[PIXELS], expected[PIXELS], got[PIXELS];
    static shape cube, ball;
    caller c;
    open_caller(&c, OFFSET + 2 * sizeof cube.xyz, options);
    ck_skg(image(&c, before));
    bend(&c, CUBE, 0.125F, &cube);
    bend(&c, BALL, 0.25F, &ball);
    expect(&cube, &ball, options, expected);
    send(&c, &cube, OFFSET);
    ck_skg(place(&c, CUBE, &cube, OFFSET));
    send(&c, &ball, OFFSET + sizeof cube.xyz);
    ck_skg(place(&c, BALL, &ball, OFFSET + sizeof cube.xyz));
    for (int again = 0; again < 2; again++) { /* they stay for later frames */
        ck_skg(image(&c, got));
        ck_assert_mem_eq(got, expected, sizeof got);
    }
    ck_assert(memcmp(got, before, sizeof got) != 0);
    close_caller(&c);
}

START_TEST(an_image_is_that_of_the_same_positions_on_the_host) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    compare_with_host(&options);
    options.strategy = SKG_STRATEGY_TILES;
    compare_with_host(&options);
    options.strategy = SKG_STRATEGY_ATOMICS;
    compare_with_host(&options);
}
END_TEST

/* In double precision the device has the floats that it was given. */
START_TEST(double_precision_takes_floats) {
    static float expected[PIXELS], got[PIXELS];
    static shape ball;
    caller c;
    skg_device_info info;
    skg_plan_options options;
    skg_device_info_init(&info);
    skg_plan_options_init(&options);
    options.precision = SKG_PRECISION_DOUBLE;
    open_caller(&c, sizeof ball.xyz, NULL);
    ck_skg(skg_context_device_get(c.context, &info));
    close_caller(&c);
    if (!info.double_precision) return;
    open_caller(&c, sizeof ball.xyz, &options);
    bend(&c, BALL, 0.25F, &ball);
    expect(NULL, &ball, &options, expected);
    send(&c, &ball, 0);
    ck_skg(place(&c, BALL, &ball, 0));
    ck_skg(image(&c, got));
    ck_assert_mem_eq(got, expected, sizeof got);
    close_caller(&c);
}
END_TEST

/* Wider bounds change the scale of the integers, and nothing else. */
START_TEST(wider_bounds_give_the_same_lengths) {
    static float expected[PIXELS], got[PIXELS];
    static shape ball;
    caller c;
    open_caller(&c, sizeof ball.xyz, NULL);
    bend(&c, BALL, 0.25F, &ball);
    expect(NULL, &ball, NULL, expected);
    for (int k = 0; k < 3; k++) ball.lowest[k] -= 40, ball.highest[k] += 40;
    send(&c, &ball, 0);
    ck_skg(place(&c, BALL, &ball, 0));
    ck_skg(image(&c, got));
    /* 3e-5 of 20 mm at 0.5/cm, of 60,000 keV: single precision's bar for lengths (docs/numerics.md) */
    for (int i = 0; i < PIXELS; i++) ck_assert(fabsf(got[i] - expected[i]) <= 2);
    close_caller(&c);
}
END_TEST

/* The copy waits for the caller's event, and gives one. The call waits for nothing. */
START_TEST(events_are_waited_for_and_given) {
    static float expected[PIXELS], got[PIXELS];
    static shape ball;
    caller c;
    open_caller(&c, sizeof ball.xyz, NULL);
    cl_int code = CL_SUCCESS, state = CL_COMPLETE;
    cl_event start = clCreateUserEvent(c.cl, &code), done = NULL;
    cl_command_queue own = clCreateCommandQueue(c.cl, c.device, 0, &code);
    skg_job *job = NULL;
    const skg_output output = output_of(got);
    bend(&c, BALL, 0.25F, &ball);
    expect(NULL, &ball, NULL, expected);
    ck_skg(skg_plan_positions_set_cl(c.plan, BALL, c.buffer, 0, ball.lowest, ball.highest, 1, &start, &done));
    ck_assert_int_eq(clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, NULL),
                     CL_SUCCESS);
    ck_assert_int_gt(state, CL_COMPLETE);
    ck_skg(skg_plan_submit(c.plan, 1, NULL, 1, &output, &job));
    /* Only now the positions are written, by a queue that the library does not know. */
    ck_assert_int_eq(clEnqueueWriteBuffer(own, c.buffer, CL_TRUE, 0, (size_t)ball.count * 3 * sizeof(float),
                                          ball.xyz, 0, NULL, NULL),
                     CL_SUCCESS);
    ck_assert_int_eq(clSetUserEventStatus(start, CL_COMPLETE), CL_SUCCESS);
    ck_assert_int_eq(clWaitForEvents(1, &done), CL_SUCCESS);
    ck_skg(skg_job_wait(&job));
    ck_assert_mem_eq(got, expected, sizeof got);
    clReleaseEvent(start);
    clReleaseEvent(done);
    clReleaseCommandQueue(own);
    close_caller(&c);
}
END_TEST

START_TEST(a_vertex_outside_of_the_bounds_is_put_on_them) {
    static float expected[PIXELS], got[PIXELS];
    static shape ball, cut;
    caller c;
    open_caller(&c, sizeof ball.xyz, NULL);
    bend(&c, BALL, 0, &ball);
    ball.highest[0] = 3;
    cut = ball;
    int64_t first = -1;
    for (int64_t v = 0; v < cut.count; v++) {
        if (cut.xyz[3 * v] > 3 && first < 0) first = v;
        cut.xyz[3 * v] = fminf(cut.xyz[3 * v], 3);
    }
    expect(NULL, &cut, NULL, expected);
    send(&c, &ball, 0);
    ck_skg(place(&c, BALL, &ball, 0));
    char text[64];
    snprintf(text, sizeof text, "part ball: vertex %d lies outside of the bounds", (int)first);
    for (int again = 0; again < 2; again++) {
        ck_assert_int_eq(image(&c, got), SKG_RANGE);
        ck_assert_msg(strstr(skg_last_error(), text), "%s", skg_last_error());
        ck_assert_mem_eq(got, expected, sizeof got);
    }
    find_bounds(&ball); /* the whole ball again */
    ck_skg(place(&c, BALL, &ball, 0));
    ck_skg(image(&c, got));
    close_caller(&c);
}
END_TEST

START_TEST(a_vertex_that_is_not_finite_is_named) {
    static float got[PIXELS];
    static shape ball;
    caller c;
    open_caller(&c, sizeof ball.xyz, NULL);
    for (int bad = 0; bad < 3; bad++) {
        bend(&c, BALL, 0, &ball);
        ball.xyz[3 * 17 + bad] = bad == 0 ? NAN : bad == 1 ? INFINITY : -INFINITY;
        send(&c, &ball, 0);
        ck_skg(place(&c, BALL, &ball, 0));
        ck_assert_int_eq(image(&c, got), SKG_ERR_MESH);
        ck_assert_msg(strstr(skg_last_error(), "part ball: vertex 17"), "%s", skg_last_error());
    }
    close_caller(&c);
}
END_TEST

/* The host's positions hold again once they change. */
START_TEST(the_host_takes_over_again) {
    static float before[PIXELS], got[PIXELS];
    static shape ball, still;
    caller c;
    open_caller(&c, sizeof ball.xyz, NULL);
    ck_skg(image(&c, before));
    bend(&c, BALL, 0, &still);
    bend(&c, BALL, 0.25F, &ball);
    ball.highest[0] = 0;
    send(&c, &ball, 0);
    ck_skg(place(&c, BALL, &ball, 0));
    ck_assert_int_eq(image(&c, got), SKG_RANGE);
    put(&still);
    ck_skg(image(&c, got));
    ck_assert_mem_eq(got, before, sizeof got);
    close_caller(&c);
}
END_TEST

static void add_cubes(caller *c, int count) {
    static double xyz[24 * 16];
    static int32_t corners[36 * 16];
    skg_mesh *cube = NULL, *cubes = NULL;
    ck_skg(skg_mesh_create_cube(6, &cube));
    for (int n = 0; n < count; n++) {
        ck_skg(skg_mesh_positions_get(cube, xyz + 24 * n, 0));
        ck_skg(skg_mesh_triangles_get(cube, corners + 36 * n, 0));
        for (int v = 0; v < 8; v++) xyz[24 * n + 3 * v] += 8 * n;
        for (int k = 0; k < 36; k++) corners[36 * n + k] += 8 * n;
    }
    ck_skg(skg_mesh_create(c->context, "cubes",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 8 * count,
                                              .positions = xyz,
                                              .triangles = 12 * count,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &cubes));
    skg_mesh_release(&cube);
    add_part(c, "cubes", cubes, 0.3, -1);
}

/* A tetrahedron whose triangles have vertices of their own, as in STL. */
static void add_soup(caller *c) {
    static const double corner[4][3] = {{8, 0, -4}, {-8, 6, -4}, {-8, -6, -4}, {0, 0, 6}};
    static const int32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    double xyz[12][3];
    int32_t corners[4][3];
    skg_mesh *mesh = NULL;
    for (int v = 0; v < 12; v++) {
        memcpy(xyz[v], corner[face[v / 3][v % 3]], sizeof xyz[v]);
        corners[v / 3][v % 3] = v;
    }
    ck_skg(skg_mesh_create(c->context, "soup",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 12,
                                              .positions = xyz[0],
                                              .triangles = 4,
                                              .corners = corners[0],
                                              .unit_mm = 1},
                           &mesh));
    add_part(c, "soup", mesh, 0.3, CUBE);
}

/* Cubes of 6 mm in one mesh, side by side. Moved onto each other they are as many layers, whose integers have to fit. */
START_TEST(a_mesh_moves_over_itself) {
    enum { MIDDLE = SIDE / 2 * SIDE + SIDE / 2 };
    static float lengths[PIXELS];
    static shape cubes;
    for (int count = 2; count <= 9; count++)
        for (int on_device = 0; on_device < 2; on_device++) {
            caller c;
            skg_spectrum *beam = NULL;
            skg_output output = output_of(lengths);
            open_caller(&c, sizeof cubes.xyz, NULL);
            skg_plan_release(&c.plan);
            add_cubes(&c, count);
            ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
            ck_skg(skg_plan_create(c.context, c.scene, &c.view, beam, NULL, &c.plan));
            output.kind = SKG_OUTPUT_LENGTHS;
            output.part = 2;
            bend(&c, 2, 0, &cubes);
            for (int i = 24; i < 24 * count; i++) cubes.xyz[i] = cubes.xyz[i % 24];
            find_bounds(&cubes);
            send(&c, &cubes, 0);
            if (on_device) ck_skg(place(&c, 2, &cubes, 0));
            if (!on_device) put(&cubes);
            ck_skg(skg_plan_image(c.plan, &output));
            /* Rays are oblique by a thousandth. */
            ck_assert_double_eq_tol((double)lengths[MIDDLE], 6.0 * count, 1e-5 * count);
            skg_spectrum_release(&beam);
            close_caller(&c);
        }
}
END_TEST

/* Vertices at one place may come with different roundings. The mesh stays closed all the same. */
START_TEST(vertices_at_one_place_stay_together) {
    static float expected[PIXELS], got[PIXELS];
    static shape soup;
    caller c;
    skg_spectrum *beam = NULL;
    skg_plan_report report;
    open_caller(&c, sizeof soup.xyz, NULL);
    add_soup(&c);
    bend(&c, 2, 0.125F, &soup);
    ck_assert_int_eq(place(&c, BALL, &soup, 0), SKG_STALE);
    skg_plan_release(&c.plan);
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(c.context, c.scene, &c.view, beam, NULL, &c.plan));
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(c.plan, &report));
    ck_assert_int_eq(report.leaky_parts, 0);
    send(&c, &soup, 0);
    ck_skg(place(&c, 2, &soup, 0));
    ck_skg(image(&c, expected));
    /* Vertices 3, 6, 7, ... are other names of vertices 0 to 2 and 5. */
    soup.xyz[3 * 3] -= 0.5F;
    soup.xyz[3 * 7 + 1] += 0.25F;
    soup.xyz[3 * 11 + 2] -= 0.5F;
    send(&c, &soup, 0);
    ck_skg(place(&c, 2, &soup, 0));
    ck_skg(image(&c, got));
    ck_assert_mem_eq(got, expected, sizeof got);
    skg_spectrum_release(&beam);
    close_caller(&c);
}
END_TEST

START_TEST(what_is_wrong_is_named) {
    static shape ball;
    caller c, other;
    cl_event done = NULL;
    open_caller(&c, sizeof ball.xyz, NULL);
    open_caller(&other, 64, NULL);
    bend(&c, BALL, 0, &ball);
    ck_skg_fails(place(&c, 2, &ball, 0), SKG_ERR_ARGUMENT, "part 2 of 2");
    ck_skg_fails(place(&c, BALL, &ball, 2), SKG_ERR_ARGUMENT, "no multiple");
    ck_skg_fails(place(&c, BALL, &ball, sizeof ball.xyz), SKG_ERR_ARGUMENT, "the buffer has");
    ck_skg_fails(skg_plan_positions_set_cl(c.plan, BALL, NULL, 0, ball.lowest, ball.highest, 0, NULL, &done),
                 SKG_ERR_ARGUMENT, "no buffer");
    ck_skg_fails(
        skg_plan_positions_set_cl(c.plan, BALL, other.buffer, 0, ball.lowest, ball.highest, 0, NULL, NULL),
        SKG_ERR_ARGUMENT, "another OpenCL context");
    ck_skg_fails(skg_plan_positions_set_cl(c.plan, BALL, c.buffer, 0, NULL, ball.highest, 0, NULL, NULL),
                 SKG_ERR_ARGUMENT, "bounds are NULL");
    ck_skg_fails(
        skg_plan_positions_set_cl(c.plan, BALL, c.buffer, 0, ball.lowest, ball.highest, 1, NULL, NULL),
        SKG_ERR_ARGUMENT, "no list");
    ck_skg_fails(skg_plan_positions_set_cl(NULL, BALL, c.buffer, 0, ball.lowest, ball.highest, 0, NULL, NULL),
                 SKG_ERR_ARGUMENT, "plan");
    ball.lowest[1] = ball.highest[1] + 1;
    ck_skg_fails(place(&c, BALL, &ball, 0), SKG_ERR_ARGUMENT, "the bounds along y");
    ball.lowest[1] = NAN;
    ck_skg_fails(place(&c, BALL, &ball, 0), SKG_ERR_ARGUMENT, "the bounds along y");
    ck_assert_ptr_null(done);
    close_caller(&other);
    close_caller(&c);
}
END_TEST

/* A leaky mesh can be moved, but not if rays are traced through its positions on the host. */
START_TEST(leaky_meshes_are_refused_where_rays_are_traced) {
    static shape ball;
    static float got[PIXELS];
    for (int32_t exact = 0; exact < 2; exact++) {
        caller c;
        skg_mesh *open = NULL;
        skg_spectrum *beam = NULL;
        skg_plan_options options;
        const double xyz[] = {-5, -5, 0, 5, -5, 0, 0, 5, 0, 0, 0, 5};
        const int32_t corners[] = {0, 2, 1, 0, 1, 3, 1, 2, 3};
        open_caller(&c, sizeof ball.xyz, NULL);
        skg_plan_release(&c.plan);
        ck_skg(skg_mesh_create(NULL, "open",
                               &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                  .vertices = 4,
                                                  .positions = xyz,
                                                  .triangles = 3,
                                                  .corners = corners,
                                                  .unit_mm = 1},
                               &open));
        add_part(&c, "open", open, 0.4, CUBE);
        skg_plan_options_init(&options);
        options.repair = exact ? SKG_REPAIR_EXACT : SKG_REPAIR_NEIGHBOURS;
        ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
        ck_skg(skg_plan_create(c.context, c.scene, &c.view, beam, &options, &c.plan));
        bend(&c, 2, 0.125F, &ball);
        send(&c, &ball, 0);
        if (exact)
            ck_skg_fails(place(&c, 2, &ball, 0), SKG_ERR_UNSUPPORTED, "part open: its mesh is leaky");
        else
            ck_skg(place(&c, 2, &ball, 0));
        ck_skg(image(&c, got));
        skg_spectrum_release(&beam);
        close_caller(&c);
    }
}
END_TEST

typedef struct {
    float amount;
    float images[FRAMES][PIXELS];
} worker;

/* Images of a ball that the device bends. Runs in a thread. */
static void *work(void *user) {
    worker *w = user;
    caller c;
    skg_job *jobs[FRAMES] = {NULL};
    shape *ball = calloc(1, sizeof *ball);
    open_caller(&c, sizeof ball->xyz, NULL);
    for (int n = 0; n < FRAMES; n++) {
        const skg_output output = output_of(w->images[n]);
        bend(&c, BALL, w->amount * (float)n, ball);
        send(&c, ball, 0);
        ck_skg(place(&c, BALL, ball, 0));
        ck_skg(skg_plan_submit(c.plan, 1, NULL, 1, &output, &jobs[n]));
    }
    for (int n = 0; n < FRAMES; n++) ck_skg(skg_job_wait(&jobs[n]));
    close_caller(&c);
    free(ball);
    return NULL;
}

START_TEST(two_contexts_in_two_threads) {
    static worker alone[2] = {{.amount = 0.0625F}, {.amount = -0.125F}},
                  together[2] = {{.amount = 0.0625F}, {.amount = -0.125F}};
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) work(&alone[k]);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(pthread_create(&threads[k], NULL, work, &together[k]), 0);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(pthread_join(threads[k], NULL), 0);
    for (int k = 0; k < 2; k++) {
        ck_assert_mem_eq(alone[k].images, together[k].images, sizeof alone[k].images);
        for (int n = 1; n < FRAMES; n++)
            ck_assert(memcmp(alone[k].images[n], alone[k].images[n - 1], sizeof alone[k].images[n]) != 0);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, an_image_is_that_of_the_same_positions_on_the_host);
    tcase_add_test(tests, double_precision_takes_floats);
    tcase_add_test(tests, wider_bounds_give_the_same_lengths);
    tcase_add_test(tests, events_are_waited_for_and_given);
    tcase_add_test(tests, a_vertex_outside_of_the_bounds_is_put_on_them);
    tcase_add_test(tests, a_vertex_that_is_not_finite_is_named);
    tcase_add_test(tests, the_host_takes_over_again);
    tcase_add_test(tests, a_mesh_moves_over_itself);
    tcase_add_test(tests, vertices_at_one_place_stay_together);
    tcase_add_test(tests, what_is_wrong_is_named);
    tcase_add_test(tests, leaky_meshes_are_refused_where_rays_are_traced);
    tcase_add_test(tests, two_contexts_in_two_threads);
}

SKG_SUITE_MAIN("positions", add_tests)
