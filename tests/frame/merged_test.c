/* Vertices at one place are merged on the device. No image shows it, whichever way positions come, and messages name the
 * caller's vertices. */
#include "caller.h"
#include "suite.h"
#include "support/shapes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BALL = 2, TRIANGLES_LESS = 3 };

static char said[512];
static void hear(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level <= SKG_LOG_NOTE && strstr(sentence, "at the same place"))
        snprintf(said, sizeof said, "%s", sentence);
}

/* A caller's scene with one more part, "soup": a solid whose triangles share no vertices, or the solid as it is. */
typedef struct {
    caller c;
    skg_mesh *mesh;
    float *offsets;
    int64_t vertices;
} stand;

static void plan_again(stand *s, const skg_plan_options *options) {
    skg_spectrum *beam = NULL;
    skg_plan_release(&s->c.plan);
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(s->c.context, s->c.scene, &s->c.view, beam, options, &s->c.plan));
    skg_spectrum_release(&beam);
}

static void open_stand(stand *s, const solid *body, int apart, const skg_plan_options *options) {
    solid given = apart ? solid_unwelded(body) : solid_copy(body);
    *s = (stand){0};
    open_caller(&s->c, (size_t)given.vertices * 3 * sizeof(float), NULL);
    ck_skg(skg_context_log_set(s->c.context, hear, NULL));
    ck_skg(skg_mesh_create(NULL, "soup",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = given.vertices,
                                              .positions = given.positions,
                                              .triangles = given.triangles,
                                              .corners = given.corners,
                                              .unit_mm = 1},
                           &s->mesh));
    ck_skg(skg_mesh_retain(s->mesh));
    add_part(&s->c, "soup", s->mesh, 0.3, -1);
    ck_skg(skg_mesh_offsets_get(s->mesh, &s->offsets, NULL));
    s->vertices = given.vertices;
    said[0] = '\0';
    plan_again(s, options);
    solid_free(&given);
}

static void close_stand(stand *s) {
    skg_mesh_release(&s->mesh);
    close_caller(&s->c);
}

static void take(const stand *s, float *pixels) {
    const skg_output output = output_of(pixels);
    ck_skg(skg_plan_image(s->c.plan, &output));
}

/* A ball beside the cube of the caller; leaky: without a few triangles. */
static solid make_ball(int leaky) {
    solid ball = solid_sphere(7, 20, 20);
    if (leaky) ball.triangles -= TRIANGLES_LESS;
    solid_shift(&ball, 8, 3, 1);
    solid_round(&ball);
    return ball;
}

static void shift(float *offsets, int64_t vertices) {
    for (int64_t i = 0; i < 3 * vertices; i++) offsets[i] += i % 3 == 0 ? 0.5F : 0.125F;
}

static void compare(int leaky, const skg_plan_options *options) {
    static float shared[PIXELS], apart[PIXELS], before[PIXELS];
    solid ball = make_ball(leaky);
    stand a, b;
    open_stand(&a, &ball, 0, options);
    open_stand(&b, &ball, 1, options);
    take(&a, shared), take(&b, apart);
    ck_assert_mem_eq(apart, shared, sizeof apart);
    memcpy(before, apart, sizeof before);
    shift(a.offsets, a.vertices), shift(b.offsets, b.vertices);
    ck_skg(skg_mesh_offsets_moved(a.mesh));
    ck_skg(skg_mesh_offsets_moved(b.mesh));
    take(&a, shared), take(&b, apart);
    ck_assert_mem_eq(apart, shared, sizeof apart);
    ck_assert(memcmp(apart, before, sizeof apart) != 0);
    ck_assert_str_eq(said, "");
    close_stand(&a);
    close_stand(&b);
    solid_free(&ball);
}

START_TEST(an_image_is_that_of_shared_vertices) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    skg_plan_options options;
    for (size_t i = 0; i < sizeof strategies / sizeof *strategies; i++)
        for (int leaky = 0; leaky < 2; leaky++) {
            skg_plan_options_init(&options);
            options.strategy = strategies[i];
            compare(leaky, &options);
        }
}
END_TEST

START_TEST(so_it_is_in_double_precision) {
    skg_plan_options options;
    skg_device_info info;
    caller c;
    skg_device_info_init(&info);
    open_caller(&c, 4, NULL);
    ck_skg(skg_context_device_get(c.context, &info));
    close_caller(&c);
    skg_plan_options_init(&options);
    options.precision = SKG_PRECISION_DOUBLE;
    for (int leaky = 0; leaky < 2 && info.double_precision; leaky++) compare(leaky, &options);
}
END_TEST

/* Pulls the third corner of the fifth triangle out of its place. */
static void pull(float *offsets) {
    offsets[3 * 14] += 1;
}

static void expect_pulled(const solid *ball, float *pixels) {
    stand s;
    open_stand(&s, ball, 1, NULL);
    pull(s.offsets);
    ck_skg(skg_mesh_offsets_moved(s.mesh));
    plan_again(&s, NULL); /* which finds the vertices apart, and so merges none */
    take(&s, pixels);
    ck_assert_str_eq(said, "");
    close_stand(&s);
}

START_TEST(vertices_of_a_leaky_mesh_may_part) {
    static float whole[PIXELS], expected[PIXELS], got[PIXELS];
    solid ball = make_ball(1);
    stand s;
    expect_pulled(&ball, expected);
    open_stand(&s, &ball, 1, NULL);
    take(&s, whole);
    pull(s.offsets);
    ck_skg(skg_mesh_offsets_moved(s.mesh));
    take(&s, got);
    ck_assert_ptr_nonnull(strstr(said, "soup: vertices "));
    ck_assert_mem_eq(got, expected, sizeof got);
    ck_assert(memcmp(got, whole, sizeof got) != 0);
    said[0] = '\0';
    /* together again, they stay apart on the device, and the image does not show it */
    s.offsets[3 * 14] -= 1;
    ck_skg(skg_mesh_offsets_moved(s.mesh));
    take(&s, got);
    ck_assert_mem_eq(got, whole, sizeof got);
    ck_assert_str_eq(said, "");
    close_stand(&s);
    solid_free(&ball);
}
END_TEST

static void place(const stand *s, const float *xyz) {
    float lowest[3] = {-100, -100, -100}, highest[3] = {100, 100, 100};
    ck_assert_int_eq(clEnqueueWriteBuffer(s->c.queue, s->c.buffer, CL_TRUE, 0,
                                          (size_t)s->vertices * 3 * sizeof(float), xyz, 0, NULL, NULL),
                     CL_SUCCESS);
    ck_skg(skg_plan_positions_set_cl(s->c.plan, BALL, s->c.buffer, 0, lowest, highest, 0, NULL, NULL));
}

/* The bounds decide the scale of the sums and the reference depth, and so the last bits: both images have those of the
 * device. */
static void compare_placed(int leaky, int pulled) {
    static float shared[PIXELS], apart[PIXELS];
    solid ball = make_ball(leaky), soup = solid_unwelded(&ball);
    stand a, b;
    /* In `a` no two vertices are at one place on the host, so that none are merged. */
    for (int64_t v = 0; v < soup.vertices; v++) soup.positions[3 * v] += leaky ? 1e-3 * (double)v : 0;
    open_stand(&a, leaky ? &soup : &ball, 0, NULL);
    open_stand(&b, &ball, 1, NULL);
    float *xyz = malloc((size_t)b.vertices * 3 * sizeof *xyz),
          *same = malloc((size_t)b.vertices * 3 * sizeof *same);
    memcpy(xyz, b.offsets, (size_t)b.vertices * 3 * sizeof *xyz);
    shift(xyz, b.vertices);
    if (pulled) pull(xyz);
    memcpy(same, a.offsets, (size_t)a.vertices * 3 * sizeof *same);
    if (leaky) {
        float *now = NULL;
        const double *from = NULL, *to = NULL;
        ck_skg(skg_mesh_offsets_get(a.mesh, &now, &to));
        ck_skg(skg_mesh_offsets_get(b.mesh, &now, &from));
        for (int64_t i = 0; i < 3 * b.vertices; i++)
            same[i] = (float)((double)xyz[i] + from[i % 3] - to[i % 3]);
    } else
        shift(same, a.vertices);
    place(&a, same), place(&b, xyz);
    take(&a, shared), take(&b, apart);
    for (int i = 0; i < PIXELS;
         i++) /* 1000 photons of 60 keV; origins differ if leaky, by which the last bits do */
        ck_assert_double_le(fabs((double)apart[i] - (double)shared[i]), leaky ? 60000 * 1e-5 : 0);
    free(xyz);
    free(same);
    close_stand(&a);
    close_stand(&b);
    solid_free(&ball);
    solid_free(&soup);
}

START_TEST(positions_of_the_device_are_taken) {
    compare_placed(0, 0);
    compare_placed(1, 0);
    compare_placed(1, 1);
}
END_TEST

/* The place of vertex 14 is far away, and the pose takes it beyond what a float holds. */
START_TEST(messages_name_the_callers_vertices) {
    static float pixels[PIXELS];
    solid ball = make_ball(0), soup = solid_unwelded(&ball);
    double pose[16] = {[5] = 1, [10] = 1, [15] = 1};
    char expected[64];
    stand s;
    open_stand(&s, &ball, 1, NULL);
    int64_t first = 0;
    const double *far = soup.positions + 3 * 14;
    while (memcmp(soup.positions + 3 * first, far, 3 * sizeof *far) != 0) first++;
    for (int64_t v = 0; v < soup.vertices; v++)
        if (memcmp(soup.positions + 3 * v, far, 3 * sizeof *far) == 0) s.offsets[3 * v] = 1e30F;
    ck_skg(skg_mesh_offsets_moved(s.mesh));
    pose[0] = 1e30;
    ck_skg(skg_scene_part_pose_set(s.c.scene, BALL, pose));
    snprintf(expected, sizeof expected, "part soup: vertex %lld", (long long)first);
    const skg_output output = output_of(pixels);
    ck_skg_fails(skg_plan_image(s.c.plan, &output), SKG_ERR_MESH, expected);
    close_stand(&s);
    solid_free(&ball);
    solid_free(&soup);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, an_image_is_that_of_shared_vertices);
    tcase_add_test(tests, so_it_is_in_double_precision);
    tcase_add_test(tests, vertices_of_a_leaky_mesh_may_part);
    tcase_add_test(tests, positions_of_the_device_are_taken);
    tcase_add_test(tests, messages_name_the_callers_vertices);
}

SKG_SUITE_MAIN("merged", add_tests)
