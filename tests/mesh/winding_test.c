/* Meshes that are wound inconsistently: turned, counted, and what cannot be turned stays. */
#include "core/maths.h"
#include "mesh/mesh.h"
#include "mesh/mesh_health.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

static double positions[3 * 8192];
static int32_t corners[3 * 16384];
static int64_t vertices, triangles;

/* Adds a mesh; scale: of its positions; -1 as `sign`: its triangles face the other way. */
static void add(skg_mesh *(*make)(void), double scale, const double at[3], int sign) {
    skg_mesh *piece = make();
    int64_t more = 0, faces = 0;
    ck_skg(skg_mesh_count(piece, &more, &faces));
    ck_skg(skg_mesh_positions_get(piece, positions + 3 * vertices, 3));
    ck_skg(skg_mesh_triangles_get(piece, corners + 3 * triangles, 3));
    skg_mesh_release(&piece);
    for (int64_t i = 0; i < 3 * more; i++)
        positions[3 * vertices + i] = scale * positions[3 * vertices + i] + at[i % 3];
    for (int64_t i = 3 * triangles; i < 3 * (triangles + faces); i++) corners[i] += (int32_t)vertices;
    for (int64_t t = triangles; sign < 0 && t < triangles + faces; t++) {
        const int32_t second = corners[3 * t + 1];
        corners[3 * t + 1] = corners[3 * t + 2], corners[3 * t + 2] = second;
    }
    vertices += more, triangles += faces;
}

static void turn(int64_t t) {
    const int32_t second = corners[3 * t + 1];
    corners[3 * t + 1] = corners[3 * t + 2], corners[3 * t + 2] = second;
}

static skg_mesh *cube(void) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cube(2, &mesh));
    return mesh;
}

static skg_mesh *ball(void) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_sphere(1, 24, &mesh));
    return mesh;
}

static const double origin[3] = {0, 0, 0};

static skg_mesh_health health_wound(int32_t as_wound, int64_t skipped) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create(NULL, "thing",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .as_wound = as_wound,
                                              .vertices = vertices,
                                              .positions = positions,
                                              .triangles = triangles - skipped,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mesh));
    const skg_mesh_health health = health_of(mesh);
    skg_mesh_release(&mesh);
    return health;
}

static void clear(void) {
    vertices = triangles = 0;
}

START_TEST(a_turned_face_of_a_cube) {
    clear();
    add(cube, 1, origin, 1);
    turn(4), turn(5);
    skg_mesh_health health = health_wound(1, 0);
    ck_assert_int_eq(health.closed, 0);
    ck_assert_int_eq(health.open_edges, 8);
    health = health_wound(0, 0);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.consistent, 1);
    ck_assert_int_eq(health.open_edges, 0);
    ck_assert_int_eq(health.same_way_edges, 8);
    ck_assert_int_eq(health.turned, 2);
    ck_assert_int_eq(health.first_turned, 4);
    ck_assert_double_eq(health.volume, 8);
    ck_assert_int_eq(health.flipped, 0);
}
END_TEST

/* Any triangles of a ball, also most and all of them, at random. */
START_TEST(a_ball_turned_anywhere) {
    clear();
    add(ball, 1, origin, 1);
    const double volume = health_wound(0, 0).volume;
    uint64_t state = 5;
    for (int percent = 5; percent < 100; percent += 15) {
        int64_t count = 0;
        clear();
        add(ball, 1, origin, 1);
        for (int64_t t = 0; t < triangles; t++)
            if (100 * skg_draw(&state) < percent) turn(t), count++;
        const skg_mesh_health health = health_wound(0, 0);
        ck_assert_int_eq(health.closed, 1);
        ck_assert_int_eq(health.turned, count);
        ck_assert_double_eq(health.volume, volume); /* the same triangles in the same order */
    }
}
END_TEST

/* A shell's inner wall faces inward also if just half of it, or most of it, is turned; a ball beside it faces outward. */
START_TEST(cavities_stay_cavities) {
    const double beside[3] = {5, 0, 0};
    for (int which = 0; which < 8; which++) {
        clear();
        add(ball, 0.5, origin, -1);
        const int64_t inner = triangles;
        add(ball, 1, origin, 1);
        const int64_t both = triangles;
        add(ball, 0.25, beside, 1);
        const double volume = health_wound(0, 0).volume;
        for (int64_t t = 0; t < inner; t++)
            if (which & 1 && t % 4 > 0) turn(t);
        for (int64_t t = inner; t < both; t++)
            if (which & 2 && t % 2) turn(t);
        for (int64_t t = both; t < triangles; t++)
            if (which & 4 && t % 8 > 0) turn(t);
        const skg_mesh_health health = health_wound(0, 0);
        ck_assert_int_eq(health.closed, 1);
        ck_assert_double_eq_tol(health.volume, volume, 8 * DBL_EPSILON * volume);
    }
}
END_TEST

/* Two cubes that share an edge of four triangles: each is turned by itself. A hole stays a hole. */
START_TEST(edges_of_four_triangles_and_holes) {
    const double beside[3] = {2, 2, 0};
    clear();
    add(cube, 1, origin, 1);
    add(cube, 1, beside, 1);
    turn(3), turn(14), turn(23);
    skg_mesh_health health = health_wound(0, 0);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.nonmanifold_edges, 1);
    ck_assert_int_eq(health.turned, 3);
    ck_assert_double_eq(health.volume, 16);
    health = health_wound(0, 1); /* the last triangle, a turned one, is left out */
    ck_assert_int_eq(health.closed, 0);
    ck_assert_int_eq(health.open_edges, 3);
    ck_assert_int_eq(health.turned, 2);
}
END_TEST

/* A Moebius strip has no inside: it stays as it is, and is named. */
START_TEST(a_moebius_strip_is_named) {
    enum { SIDES = 12 };
    clear();
    for (int i = 0; i < SIDES; i++)
        for (int side = -1; side <= 1; side += 2) {
            const double turn_angle = 2 * SKG_PI * i / SIDES, half = turn_angle / 2;
            double *p = positions + 3 * vertices++;
            p[0] = (3 + side * cos(half)) * cos(turn_angle), p[1] = (3 + side * cos(half)) * sin(turn_angle);
            p[2] = side * sin(half);
        }
    for (int i = 0; i < SIDES; i++) {
        const int last = i + 1 == SIDES; /* the ends are joined crosswise */
        const int32_t a = 2 * i, b = 2 * i + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        const int32_t faces[6] = {a, b, c, b, d, c};
        memcpy(corners + 3 * triangles, faces, sizeof faces);
        triangles += 2;
    }
    int32_t before[6 * SIDES];
    memcpy(before, corners, sizeof before);
    skg_mesh_health health = health_wound(0, 0);
    ck_assert_int_eq(health.one_sided, 1);
    ck_assert_int_eq(health.turned, 0);
    ck_assert_int_eq(health.closed, 0);
    add(cube, 1, (const double[3]){20, 0, 0}, 1); /* beside it, what can be turned is */
    turn(2 * SIDES + 1);
    health = health_wound(0, 0);
    ck_assert_int_eq(health.one_sided, 1);
    ck_assert_int_eq(health.turned, 1);
    ck_assert_int_eq(health.first_turned, 2 * SIDES + 1);
    ck_assert_mem_eq(before, corners, sizeof before);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, a_turned_face_of_a_cube);
    tcase_add_test(tests, a_ball_turned_anywhere);
    tcase_add_test(tests, cavities_stay_cavities);
    tcase_add_test(tests, edges_of_four_triangles_and_holes);
    tcase_add_test(tests, a_moebius_strip_is_named);
}

SKG_SUITE_MAIN("winding", add_tests)
