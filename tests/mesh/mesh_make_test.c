/* Meshes that are made: cuboid, sphere, cylinder, step wedge. */
#include "mesh/mesh.h"
#include "mesh/mesh_health.h"
#include "support/angles.h"

#include <float.h>
#include <math.h>

/* One closed surface of the sphere's topology: V - E + F = 2 with E = 3 F / 2. */
static void check_perfect(const skg_mesh *mesh, double volume, double area) {
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.consistent, 1);
    ck_assert_int_eq(health.outward, 1);
    ck_assert_int_eq(health.flipped, 0);
    ck_assert_int_eq(health.welded_vertices, health.vertices);
    ck_assert_int_eq(health.duplicate_triangles, 0);
    ck_assert_int_eq(health.degenerate_triangles, 0);
    ck_assert_int_eq(health.nonmanifold_edges, 0);
    ck_assert_int_eq(health.components, 1);
    ck_assert_int_eq(health.open_edges, 0);
    ck_assert_int_eq(health.first_open_vertex, -1);
    ck_assert_int_eq(2 * health.vertices - health.triangles, 4);
    /* Thousands of terms of some epsilon each. */
    ck_assert_double_eq_tol(health.volume / volume, 1, 1e-12);
    if (area > 0) ck_assert_double_eq_tol(health.area / area, 1, 1e-12);
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq_tol(health.bounds[k], -health.bounds[3 + k],
                                4 * DBL_EPSILON * health.bounds[3 + k]);
}

static double polygon_area(double radius, int64_t corners) {
    return 0.5 * (double)corners * radius * radius * sin(2 * pi / (double)corners);
}

START_TEST(cuboids_are_closed_and_outward) {
    skg_mesh *mesh;
    ck_skg(skg_mesh_create_cube(10, &mesh));
    check_perfect(mesh, 1000, 600);
    skg_mesh_release(&mesh);
    ck_assert_ptr_null(mesh);
    ck_skg(skg_mesh_create_cuboid(1, 2, 3, &mesh));
    check_perfect(mesh, 6, 22);
    ck_assert_double_eq(health_of(mesh).bounds[5], 1.5);
    skg_mesh_release(&mesh);
}
END_TEST

/* Bands between rings of polygons are frusta: h/3 (A + sqrt(A B) + B). */
START_TEST(sphere_has_its_vertices_on_the_sphere) {
    static const int64_t segments[] = {3, 4, 5, 64};
    for (size_t i = 0; i < sizeof segments / sizeof *segments; i++) {
        int64_t n = segments[i], bands = n / 2 < 2 ? 2 : n / 2;
        double volume = 0;
        for (int64_t b = 0; b < bands; b++) {
            double a = pi * (double)b / (double)bands, c = pi * (double)(b + 1) / (double)bands;
            double lower = polygon_area(50 * sin(a), n), upper = polygon_area(50 * sin(c), n);
            volume += 50 * (cos(a) - cos(c)) / 3 * (lower + sqrt(lower * upper) + upper);
        }
        skg_mesh *mesh;
        ck_skg(skg_mesh_create_sphere(50, n, &mesh));
        skg_mesh_health health = health_of(mesh);
        /* Thousands of terms. */
        ck_assert_double_eq_tol(health.volume / volume, 1, 4096 * DBL_EPSILON);
        ck_assert_int_eq(health.closed && health.outward && health.consistent, 1);
        ck_assert_int_eq(2 * health.vertices - health.triangles, 4);
        ck_assert_int_eq(health.components, 1);
        ck_assert_double_eq(health.bounds[5], 50);
        for (int64_t v = 0; v < health.vertices; v++) {
            double p[3];
            skg_mesh_vertex(mesh, v, p);
            ck_assert_double_eq_tol(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), 50, 200 * DBL_EPSILON);
        }
        skg_mesh_release(&mesh);
    }
}
END_TEST

START_TEST(cylinder_is_a_prism) {
    skg_mesh *mesh;
    for (int64_t n = 4; n < 100; n += 24) {
        ck_skg(skg_mesh_create_cylinder(7, 20, n, &mesh));
        double side = 2 * 7 * sin(pi / (double)n);
        check_perfect(mesh, 20 * polygon_area(7, n), 2 * polygon_area(7, n) + 20 * side * (double)n);
        skg_mesh_release(&mesh);
    }
    ck_skg(skg_mesh_create_cylinder(7, 20, 3, &mesh));
    ck_assert_double_eq_tol(health_of(mesh).volume, 20 * polygon_area(7, 3), 32 * DBL_EPSILON * 1273);
    skg_mesh_release(&mesh);
}
END_TEST

/* Volume: l w h (n+1)/2n. Area: floor and treads 2 l w, risers and the tall end 2 w h, two sides. */
START_TEST(step_wedge_has_its_steps) {
    for (int64_t n = 1; n < 12; n++) {
        skg_mesh *mesh;
        double side = 60 * 8 * (double)(n + 1) / (double)(2 * n);
        ck_skg(skg_mesh_create_step_wedge(60, 20, 8, n, &mesh));
        check_perfect(mesh, 20 * side, 2 * 60 * 20 + 2 * 20 * 8 + 2 * side);
        skg_mesh_release(&mesh);
    }
}
END_TEST

/* Every step is 20 x 10; risers have the height from one to the next. */
START_TEST(steps_have_the_heights_that_are_asked) {
    const double heights[3] = {1, 5, 7}, falling[2] = {2, 2};
    skg_mesh *mesh;
    ck_skg(skg_mesh_create_steps(60, 10, 3, heights, &mesh));
    check_perfect(mesh, 20 * 10 * (1 + 5 + 7), 2 * 60 * 10 + 2 * 10 * 7 + 2 * 20 * (1 + 5 + 7));
    ck_assert_double_eq(health_of(mesh).bounds[5], 3.5);
    skg_mesh_release(&mesh);
    ck_skg_fails(skg_mesh_create_steps(60, 10, 2, falling, &mesh), SKG_ERR_ARGUMENT, "step 1 is 2 mm high");
    ck_skg_fails(skg_mesh_create_steps(60, 10, 0, heights, &mesh), SKG_ERR_ARGUMENT, "0 steps");
    ck_skg_fails(skg_mesh_create_steps(60, 10, 3, NULL, &mesh), SKG_ERR_ARGUMENT, "heights");
}
END_TEST

START_TEST(makers_refuse_what_is_no_length_or_count) {
    skg_mesh *mesh;
    ck_skg_fails(skg_mesh_create_cube(0, &mesh), SKG_ERR_ARGUMENT, "cube: edge 0 mm");
    ck_assert_ptr_null(mesh);
    ck_skg_fails(skg_mesh_create_cuboid(1, -2, 3, &mesh), SKG_ERR_ARGUMENT, "along y");
    ck_skg_fails(skg_mesh_create_sphere((double)INFINITY, 8, &mesh), SKG_ERR_ARGUMENT, "radius");
    ck_skg_fails(skg_mesh_create_sphere(1, 2, &mesh), SKG_ERR_ARGUMENT, "2 segments");
    ck_skg_fails(skg_mesh_create_sphere(1, INT64_MAX, &mesh), SKG_ERR_ARGUMENT, "segments");
    ck_skg_fails(skg_mesh_create_cylinder(1, (double)NAN, 8, &mesh), SKG_ERR_ARGUMENT, "height");
    ck_skg_fails(skg_mesh_create_cylinder(1, 1, INT64_MAX, &mesh), SKG_ERR_ARGUMENT, "segments");
    ck_skg_fails(skg_mesh_create_step_wedge(1, 1, 1, 0, &mesh), SKG_ERR_ARGUMENT, "0 steps");
    ck_skg_fails(skg_mesh_create_cube(1, NULL), SKG_ERR_ARGUMENT, "cube");
}
END_TEST

/* A fan of many triangles around vertex 0: one large group of edges. */
START_TEST(many_triangles_at_one_vertex) {
    skg_mesh *mesh;
    ck_skg(skg_mesh_create_cylinder(10, 10, 50000, &mesh));
    check_perfect(mesh, 10 * polygon_area(10, 50000), 0);
    skg_mesh_release(&mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, cuboids_are_closed_and_outward);
    tcase_add_test(tests, sphere_has_its_vertices_on_the_sphere);
    tcase_add_test(tests, cylinder_is_a_prism);
    tcase_add_test(tests, step_wedge_has_its_steps);
    tcase_add_test(tests, steps_have_the_heights_that_are_asked);
    tcase_add_test(tests, makers_refuse_what_is_no_length_or_count);
    tcase_add_test(tests, many_triangles_at_one_vertex);
}

SKG_SUITE_MAIN("mesh makers", add_tests)
