/* Surfaces of a page: fewer triangles, the same kind of surface, vertices that were there. */
#include "cli/command.h"

#include "view/surfaces.h"

#include <math.h>
#include <stdlib.h>

enum { RADIUS = 50 };

static skg_scene *make_scene(int64_t segments) {
    skg_scene *scene = NULL;
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_scene_create(NULL, &scene));
    ck_skg(skg_mesh_create_sphere(RADIUS, segments, &part.mesh));
    ck_skg(skg_material_create_mu("ball", 0.2, &part.material));
    part.label = "ball";
    part.pose[3] = 100; /* moved along x */
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    return scene;
}

/* Each edge of a closed surface belongs to two triangles, once in each direction. */
static void ck_closed(const view_surface *s) {
    const size_t vertices = (size_t)s->vertices;
    char *seen = calloc(vertices * vertices, 1);
    ck_assert_ptr_nonnull(seen);
    for (int64_t i = 0; i < 3 * s->triangles; i++) {
        const size_t a = (size_t)s->corners[i], b = (size_t)s->corners[i % 3 == 2 ? i - 2 : i + 1];
        ck_assert(a < vertices && b < vertices && a != b);
        ck_assert_int_eq(seen[a * vertices + b]++, 0);
    }
    int alone = 0;
    for (size_t a = 0; a < vertices; a++)
        for (size_t b = 0; b < a; b++) alone += seen[a * vertices + b] != seen[b * vertices + a];
    ck_assert_int_eq(alone, 0);
    free(seen);
}

START_TEST(a_ball_stays_a_ball) {
    skg_scene *scene = make_scene(64);
    view_shapes shapes;
    ck_assert_int_eq(view_shapes_make(scene, 1, _i ? 1000 : 1000000, &shapes), 0);
    ck_assert_int_eq(view_shapes_take(scene, 0, &shapes), 0);
    const view_shape *ball = shapes.shapes;
    ck_assert_int_gt(shapes.of, 3000);
    ck_assert_int_eq(shapes.triangles, ball->surface.triangles);
    if (_i && view_can_thin)
        ck_assert(ball->surface.triangles <= 1000 && ball->surface.triangles > 900);
    else
        ck_assert_int_eq(ball->surface.triangles, shapes.of);
    ck_closed(&ball->surface);
    ck_assert_int_eq(ball->surface.vertices - ball->surface.triangles / 2, 2); /* Euler: V - E + F */
    for (int64_t v = 0; v < ball->surface.vertices; v++) {
        const float *p = ball->positions + 3 * v;
        const double x = (double)p[0] - 100, y = (double)p[1], z = (double)p[2];
        /* float positions around 150 mm */
        ck_assert_double_eq_tol(sqrt(x * x + y * y + z * z), RADIUS, 4 * 150 * 1.2e-7);
    }
    ck_assert_int_eq(ball->moves, 0);
    view_shapes_free(&shapes);
    skg_scene_release(&scene);
}
END_TEST

START_TEST(what_moves_is_known) {
    skg_scene *scene = make_scene(12);
    view_shapes shapes;
    double pose[16] = {1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1, 0, 0, 0, 0, 1};
    ck_assert_int_eq(view_shapes_make(scene, 2, 100000, &shapes), 0);
    ck_assert_int_eq(view_shapes_take(scene, 0, &shapes), 0);
    ck_assert_int_eq(view_shapes_take(scene, 1, &shapes), 0);
    ck_assert_int_eq(shapes.shapes->moves, 0);
    ck_skg(skg_scene_part_pose_set(scene, 0, pose));
    ck_assert_int_eq(view_shapes_take(scene, 1, &shapes), 0);
    ck_assert_int_eq(shapes.shapes->moves, 1);
    view_shapes_free(&shapes);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, a_ball_stays_a_ball, 0, 2);
    tcase_add_test(tests, what_moves_is_known);
}

SKG_SUITE_MAIN("thin", add_tests)
