/* Bodies by their parameters: closed, outward, as large as they are asked, and none in another. */
#include "mesh/mesh.h"
#include "mesh/mesh_health.h"
#include "support/angles.h"

#include <skiagraph/bodies.h>

#include <float.h>
#include <math.h>
#include <string.h>

static skg_mesh *mesh;

static skg_mesh_health perfect(int64_t components) {
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.consistent, 1);
    ck_assert_int_eq(health.outward, 1);
    ck_assert_int_eq(health.flipped, 0);
    ck_assert_int_eq(health.components, components);
    return health;
}

/* Volume of a sphere of this many segments over that of radius 1, from the library's own sphere. */
static double share_of_sphere(int64_t segments) {
    skg_mesh *one = NULL;
    ck_skg(skg_mesh_create_sphere(1, segments, &one));
    const double volume = health_of(one).volume;
    skg_mesh_release(&one);
    return volume / (4 * pi / 3);
}

START_TEST(spheres_are_one_mesh) {
    const double centres[6] = {0, 0, 0, 5, 1, 2}, radii[2] = {1, 2};
    ck_skg(skg_mesh_create_spheres(2, centres, radii, 16, &mesh));
    const skg_mesh_health health = perfect(2);
    /* Thousands of terms of some epsilon each. */
    ck_assert_double_eq_tol(health.volume, share_of_sphere(16) * 4 * pi / 3 * 9, 1e-11);
    ck_assert_double_eq_tol(health.bounds[3], 7, 8 * DBL_EPSILON);
    skg_mesh_release(&mesh);
    ck_skg_fails(skg_mesh_create_spheres(0, centres, radii, 16, &mesh), SKG_ERR_ARGUMENT, "0 spheres");
    ck_skg_fails(skg_mesh_create_spheres(2, centres, centres, 16, &mesh), SKG_ERR_ARGUMENT, "radius 0 mm");
}
END_TEST

START_TEST(ten_thousand_spheres_do_not_overlap) {
    skg_foam foam;
    skg_foam_init(&foam);
    for (int k = 0; k < 3; k++) foam.box[k] = 60;
    foam.count = 10000, foam.spread = 0.1, foam.gap_mm = 0.01, foam.seed = 5;
    ck_skg(skg_mesh_create_foam(&foam, &mesh));
    const skg_mesh_health health = perfect(10000);
    for (int k = 0; k < 3; k++) {
        ck_assert_double_ge(health.bounds[k], -30);
        ck_assert_double_le(health.bounds[3 + k], 30);
    }
    skg_mesh_nesting nesting;
    skg_mesh_nesting_init(&nesting);
    ck_skg(skg_mesh_nesting_get(mesh, &nesting));
    ck_assert_int_eq(nesting.inverted, 0);
    skg_mesh_release(&mesh);
}
END_TEST

/* Centres and radii of the spheres of a foam, from the poles of each. */
START_TEST(a_foam_fills_its_fraction_and_repeats) {
    enum { LIMIT = 2000 };
    static double positions[2][3 * LIMIT * 62];
    skg_foam foam;
    int64_t vertices = 0, triangles = 0;
    skg_foam_init(&foam);
    foam.fraction = 0.2;
    for (int again = 0; again < 2; again++) {
        ck_skg(skg_mesh_create_foam(&foam, &mesh));
        ck_skg(skg_mesh_count(mesh, &vertices, &triangles));
        ck_assert_int_le(vertices, LIMIT * 62);
        ck_skg(skg_mesh_positions_get(mesh, positions[again], 3));
        const double volume = health_of(mesh).volume / share_of_sphere(12);
        /* The last sphere is that with which the share of the box is reached: at most one of radius 1 too much. */
        ck_assert_double_ge(volume, 0.2 * 8000);
        ck_assert_double_le(volume, 0.2 * 8000 + 4 * pi / 3);
        skg_mesh_release(&mesh);
    }
    ck_assert_mem_eq(positions[0], positions[1], (size_t)(3 * vertices) * sizeof(double));
    const int64_t spheres = vertices / 62; /* two poles and five rings of twelve */
    for (int64_t i = 0; i < spheres; i++)
        for (int64_t j = 0; j < i; j++) {
            const double *a = positions[0] + 3 * 62 * i, *b = positions[0] + 3 * 62 * j;
            ck_assert_double_ge(hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]),
                                2 * (1 - 1e-12)); /* roundings */
        }
    foam.seed = 1;
    ck_skg(skg_mesh_create_foam(&foam, &mesh));
    ck_skg(skg_mesh_positions_get(mesh, positions[1], 3));
    ck_assert_int_ne(memcmp(positions[0], positions[1], 3 * sizeof(double)), 0);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(a_foam_that_does_not_fit_is_refused) {
    skg_foam foam;
    skg_foam_init(&foam);
    foam.fraction = 0.6;
    ck_skg_fails(skg_mesh_create_foam(&foam, &mesh), SKG_ERR_MESH, "no place is left for sphere");
    foam.fraction = 0.7;
    ck_skg_fails(skg_mesh_create_foam(&foam, &mesh), SKG_ERR_ARGUMENT, "fraction 0.7");
    skg_foam_init(&foam);
    foam.radius_mm = 11;
    ck_skg_fails(skg_mesh_create_foam(&foam, &mesh), SKG_ERR_ARGUMENT, "does not fit");
    foam.spread = -1;
    ck_skg_fails(skg_mesh_create_foam(&foam, &mesh), SKG_ERR_ARGUMENT, "spread -1");
    ck_assert_ptr_null(mesh);
}
END_TEST

START_TEST(fibres_are_tubes_from_face_to_face) {
    skg_fibres fibres;
    skg_fibres_init(&fibres);
    ck_skg(skg_mesh_create_fibres(&fibres, &mesh));
    skg_mesh_health health = perfect(50);
    /* Prisms of 16 corners; sums of thousands of terms. */
    ck_assert_double_eq_tol(health.volume, 50 * 20 * 0.5 * 16 * 0.25 * sin(2 * pi / 16), 1e-9);
    skg_mesh_release(&mesh);
    fibres.tilt_deg = 30, fibres.gap_mm = 0.1, fibres.seed = 2;
    ck_skg(skg_mesh_create_fibres(&fibres, &mesh));
    health = perfect(50);
    ck_assert_double_eq(health.bounds[5], 10);
    ck_assert_double_ge(health.bounds[0], -10);
    skg_mesh_release(&mesh);
    fibres.count = 2000;
    ck_skg_fails(skg_mesh_create_fibres(&fibres, &mesh), SKG_ERR_MESH, "no place is left after");
    fibres.tilt_deg = 70;
    ck_skg_fails(skg_mesh_create_fibres(&fibres, &mesh), SKG_ERR_ARGUMENT, "tilt 70");
}
END_TEST

/* A plane distance is linear, so that its surface is exact; beyond the volume the surface ends half a cell outside. */
START_TEST(an_isosurface_is_closed) {
    const int64_t counts[3] = {4, 3, 5};
    const double spacing[3] = {1, 2, 0.5};
    float values[60], low[60];
    for (int i = 0; i < 60; i++) values[i] = 1, low[i] = (float)(i % 4) - 1.25f;
    ck_skg(skg_mesh_create_isosurface(counts, spacing, values, 0, &mesh));
    ck_assert_double_eq_tol(perfect(1).bounds[3], 2, 4 * DBL_EPSILON);
    skg_mesh_release(&mesh);
    ck_skg(skg_mesh_create_isosurface(counts, spacing, low, 0, &mesh));
    ck_assert_double_eq_tol(perfect(1).bounds[0], -0.25,
                            4 * DBL_EPSILON); /* 1.25 cells from the first value */
    skg_mesh_release(&mesh);
    ck_skg_fails(skg_mesh_create_isosurface(counts, spacing, values, 2, &mesh), SKG_ERR_MESH,
                 "no value reaches");
    values[7] = (float)NAN;
    ck_skg_fails(skg_mesh_create_isosurface(counts, spacing, values, 0, &mesh), SKG_ERR_MESH, "value 7");
}
END_TEST

/* Vertices less edges plus faces of a closed surface. */
static int64_t euler_number(void) {
    const skg_mesh_health health = health_of(mesh);
    return health.welded_vertices - health.triangles / 2;
}

START_TEST(a_gyroid_is_one_sheet) {
    const double box[3] = {20, 15, 10};
    /* A hole in the sheet is a handle of its surface, which takes 2 from Euler's number, however fine the grid is. With 24 cells it was -446. */
    static const int64_t cells[] = {64, 32, 0};
    for (int k = 0; k < 3; k++) {
        ck_skg(skg_mesh_create_gyroid(box, 8, 0.3, cells[k], &mesh));
        ck_assert_int_eq(euler_number(), -102);
        if (cells[k]) skg_mesh_release(&mesh);
    }
    const skg_mesh_health health = perfect(1);
    /* The sheet's share of a whole period is 0.195; the box holds parts of periods. */
    ck_assert_double_eq_tol(health.volume / 3000, 0.195, 0.02);
    ck_assert_double_le(health.bounds[3], 10 * (1 + DBL_EPSILON));
    skg_mesh_release(&mesh);
    ck_skg_fails(skg_mesh_create_gyroid(box, 8, 2, 24, &mesh), SKG_ERR_ARGUMENT, "level 2");
    ck_skg_fails(skg_mesh_create_gyroid(box, 8, 0, 0, &mesh), SKG_ERR_ARGUMENT, "level 0: above 0");
    ck_skg_fails(skg_mesh_create_gyroid(box, 8, (double)NAN, 0, &mesh), SKG_ERR_ARGUMENT, "above 0 to 1.4");
    ck_skg_fails(skg_mesh_create_gyroid(box, 8, 0.3, 31, &mesh), SKG_ERR_ARGUMENT,
                 "may have holes; give at least 32");
    ck_skg_fails(skg_mesh_create_gyroid(box, 8, 0.03, 0, &mesh), SKG_ERR_ARGUMENT, "give at least 0.037");
    ck_skg_fails(skg_mesh_create_gyroid(box, 0.01, 1, 256, &mesh), SKG_ERR_ARGUMENT, "2000");
}
END_TEST

START_TEST(line_pairs_are_bars) {
    const double per_mm[3] = {0.5, 1, 2};
    ck_skg(skg_mesh_create_line_pairs(3, per_mm, 4, 20, 1, &mesh));
    const skg_mesh_health health = perfect(12);
    ck_assert_double_eq_tol(health.volume, 4 * 20 * (1 + 0.5 + 0.25), 1e-10); /* sums of some hundred terms */
    ck_assert_double_eq_tol(health.bounds[3], 0.5 * (7 + 2 + 3.5 + 1 + 1.75), 1e-14);
    skg_mesh_release(&mesh);
    ck_skg_fails(skg_mesh_create_line_pairs(3, per_mm, 0, 20, 1, &mesh), SKG_ERR_ARGUMENT, "0 bars");
}
END_TEST

START_TEST(a_star_is_half_a_ring) {
    ck_skg(skg_mesh_create_star(20, 1, 36, 0.5, &mesh));
    /* Chords of 5/3 degrees: a circle's area times sin(t) / t. */
    const double t = pi / 36 / 3;
    ck_assert_double_eq_tol(perfect(36).volume, 0.5 * pi * 399 * 0.5 * sin(t) / t, 1e-10);
    skg_mesh_release(&mesh);
    ck_skg_fails(skg_mesh_create_star(20, 20, 36, 0.5, &mesh), SKG_ERR_ARGUMENT, "inner radius 20 mm");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, spheres_are_one_mesh);
    tcase_add_test(tests, ten_thousand_spheres_do_not_overlap);
    tcase_add_test(tests, a_foam_fills_its_fraction_and_repeats);
    tcase_add_test(tests, a_foam_that_does_not_fit_is_refused);
    tcase_add_test(tests, fibres_are_tubes_from_face_to_face);
    tcase_add_test(tests, an_isosurface_is_closed);
    tcase_add_test(tests, a_gyroid_is_one_sheet);
    tcase_add_test(tests, line_pairs_are_bars);
    tcase_add_test(tests, a_star_is_half_a_ring);
}

SKG_SUITE_MAIN("bodies", add_tests)
