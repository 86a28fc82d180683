/* Distances of surfaces against brute force and formulas. */
#define _GNU_SOURCE /* memmem, mkstemps */
/* Distances between surfaces: closed forms, and brute force that shares no code with the library. */
#include "core/maths.h"
#include "distance/nearest.h"
#include "suite.h"
#include "support/random.h"

#include <skiagraph/distance.h>

#include <float.h>
#include <math.h>
#include <omp.h>
#include <string.h>

static long double minus(double a, double b) {
    return (long double)a - (long double)b;
}

/* The distance from a point to a segment, in long double. */
static long double to_segment(const double *a, const double *b, const double *p) {
    long double along = 0, square = 0, away = 0;
    for (int k = 0; k < 3; k++) {
        along += minus(b[k], a[k]) * minus(p[k], a[k]);
        square += minus(b[k], a[k]) * minus(b[k], a[k]);
    }
    long double t = square > 0 ? along / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (int k = 0; k < 3; k++) {
        const long double d = t * minus(b[k], a[k]) - minus(p[k], a[k]);
        away += d * d;
    }
    return sqrtl(away);
}

/* The distance from a point to a triangle: to its plane if the foot lies inside, by the signs of three areas, and to its
 * edges otherwise. */
static long double to_triangle(const double *a, const double *b, const double *c, const double *p) {
    const double *corner[3] = {a, b, c};
    long double normal[3], e[3], f[3], size = 0, away = 0;
    for (int k = 0; k < 3; k++) e[k] = minus(b[k], a[k]), f[k] = minus(c[k], a[k]);
    for (int k = 0; k < 3; k++) normal[k] = e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
    for (int k = 0; k < 3; k++) size += normal[k] * normal[k], away += normal[k] * minus(p[k], a[k]);
    int inside = size > 0;
    for (int s = 0; s < 3 && inside; s++) {
        const double *from = corner[s], *to = corner[(s + 1) % 3];
        long double side = 0;
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            side += normal[k] * (minus(to[i], from[i]) * minus(p[j], from[j]) -
                                 minus(to[j], from[j]) * minus(p[i], from[i]));
        }
        inside = side >= 0;
    }
    if (inside) return fabsl(away) / sqrtl(size);
    return fminl(to_segment(a, b, p), fminl(to_segment(b, c, p), to_segment(c, a, p)));
}

static double brute(int64_t triangles, const double *positions, const int32_t *corners, const double *p) {
    long double least = HUGE_VALL;
    for (int64_t t = 0; t < triangles; t++)
        least = fminl(least, to_triangle(positions + 3 * corners[3 * t], positions + 3 * corners[3 * t + 1],
                                         positions + 3 * corners[3 * t + 2], p));
    return (double)least;
}

enum { SOUP = 700, POINTS = 400 };

/* Random triangles of all sizes. kind 1: slivers, 2: without area, 3: one corner thrice. */
static void make_soup(int kind, uint64_t *state, double *positions, int32_t *corners) {
    for (int64_t t = 0; t < SOUP; t++) {
        double *p = positions + 9 * t;
        const double size = pow(10, 3 * draw(state, 0, 1) - 1);
        for (int k = 0; k < 9; k++) p[k] = 200 * draw(state, 0, 1) - 100;
        for (int k = 0; k < 3; k++)
            p[3 + k] = p[k] + size * (draw(state, 0, 1) - 0.5),
                  p[6 + k] = p[k] + size * (draw(state, 0, 1) - 0.5);
        const double along = draw(state, 0, 1), off = kind == 1 ? 1e-7 : 0;
        for (int k = 0; k < 3 && kind > 0; k++)
            p[6 + k] = kind == 3 ? p[k] : p[k] + along * (p[3 + k] - p[k]) + off * (draw(state, 0, 1) - 0.5);
        if (kind == 3) memcpy(p + 3, p, 3 * sizeof *p);
        for (int c = 0; c < 3; c++) corners[3 * t + c] = (int32_t)(3 * t + c);
    }
}

START_TEST(nearest_points_are_those_of_brute_force) {
    static double positions[9 * SOUP];
    static int32_t corners[3 * SOUP];
    uint64_t state = 17;
    skg_tree tree;
    make_soup(_i, &state, positions, corners);
    ck_skg(skg_tree_create("soup", positions, SOUP, corners, &tree));
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        const double reach = i % 3 == 0 ? 2000 : 220; /* far away, or among them */
        for (int k = 0; k < 3; k++) p[k] = reach * (draw(&state, 0, 1) - 0.5);
        if (i % 7 == 0) memcpy(p, positions + 9 * i, sizeof p); /* at a corner */
        const double expected = brute(SOUP, positions, corners, p);
        int64_t triangle;
        const double found = sqrt(skg_tree_nearest(&tree, p, HUGE_VAL, &triangle));
        /* The bar. Coordinates are to 1000 mm, of which 1e-9 is 9000 epsilons. */
        ck_assert_double_eq_tol(found, expected, 1e-9);
        const int32_t *c = corners + 3 * triangle;
        ck_assert_double_eq_tol(
            (double)to_triangle(positions + 3 * c[0], positions + 3 * c[1], positions + 3 * c[2], p),
            expected, 1e-9); /* as above */
        /* A bound that holds changes nothing; one that does not is the result. */
        ck_assert_double_eq(skg_tree_nearest(&tree, p, 4 * found * found + 1, NULL),
                            skg_tree_nearest(&tree, p, HUGE_VAL, NULL));
        if (found > 0) {
            ck_assert_double_eq(skg_tree_nearest(&tree, p, found * found / 4, &triangle), found * found / 4);
            ck_assert_int_eq(triangle, -1);
        }
    }
    skg_tree_free(&tree);
}
END_TEST

static skg_distance between(const skg_mesh *from, const skg_mesh *to, const skg_distance_options *options) {
    skg_distance d;
    skg_distance_init(&d);
    ck_skg(skg_distance_measure(from, to, options, &d));
    return d;
}

/* A square of two triangles in z = height + slope x, from x = 0 to width; so wide in y that no edge matters. */
static skg_mesh *make_square(double x, double width, double height, double slope) {
    const double far = x + width;
    const double p[] = {x,   -width, height + slope * x,   far, -width, height + slope * far,
                        far, width,  height + slope * far, x,   width,  height + slope * x};
    const int32_t corners[] = {0, 1, 2, 0, 2, 3};
    skg_mesh *mesh;
    ck_skg(skg_mesh_create(NULL, "square",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 4,
                                              .positions = p,
                                              .triangles = 2,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mesh));
    return mesh;
}

START_TEST(parallel_planes) {
    skg_mesh *low = make_square(-100, 200, 0, 0), *high = make_square(-50, 100, 7.25, 0);
    for (int32_t sampling = 0; sampling < 2; sampling++) {
        skg_distance_options options;
        skg_distance_options_init(&options);
        options.sampling = sampling;
        const skg_distance d = between(high, low, &options);
        const double epsilon = 64 * DBL_EPSILON * 7.25; /* sums of equal terms */
        ck_assert_double_eq_tol(d.mean_mm, 7.25, 1e4 * epsilon);
        ck_assert_double_eq_tol(d.rms_mm, 7.25, 1e4 * epsilon);
        ck_assert_double_eq_tol(d.p95_mm, 7.25, epsilon);
        ck_assert_double_eq_tol(d.max_mm, 7.25, epsilon);
        ck_assert_int_eq(d.sampling, sampling);
        if (sampling == SKG_DISTANCE_VERTICES) ck_assert_int_eq(d.samples, 4);
    }
    skg_mesh_release(&low);
    skg_mesh_release(&high);
}
END_TEST

/* Over a ramp the distance from z = 0 grows in proportion: mean 1/2, root mean square 1/sqrt 3, percentile 0.95 of the
 * greatest. */
START_TEST(a_ramp) {
    skg_mesh *floor_ = make_square(-1000, 2000, 0, 0), *ramp = make_square(0, 100, 0, 0.25);
    skg_distance_options options;
    skg_distance_options_init(&options);
    options.spacing_mm = 1;
    const skg_distance d = between(ramp, floor_, &options);
    ck_assert_double_le(d.spacing_mm, 1);
    const double step = 0.25 / 25; /* of a small triangle, relative to the greatest distance, 25 mm */
    ck_assert_double_eq_tol(d.mean_mm, 12.5, 1e-9);                    /* linear: exact but for rounding */
    ck_assert_double_eq_tol(d.rms_mm, 25 / sqrt(3), 25 * step * step); /* midpoint rule */
    ck_assert_double_eq_tol(d.p95_mm, 0.95 * 25, 25 * step);           /* one sample */
    ck_assert_double_eq_tol(d.max_mm, 25, 64 * DBL_EPSILON * 25);
    ck_assert_double_eq_tol(d.max_position_mm[0], 100, 64 * DBL_EPSILON * 100);
    skg_mesh_release(&floor_);
    skg_mesh_release(&ramp);
}
END_TEST

/* Concentric spheres: every distance is the difference of the radii but for the chords' heights. */
START_TEST(concentric_spheres) {
    skg_mesh *inner, *outer;
    const double r = 50, gap = 3, pi = 3.14159265358979;
    const int64_t segments = 200;
    ck_skg(skg_mesh_create_sphere(r, segments, &inner));
    ck_skg(skg_mesh_create_sphere(r + gap, segments, &outer));
    /* A facet lies inside its sphere by at most 1 - cos of half its diagonal's angle. */
    const double chord = (r + gap) * (1 - cos(1.5 * pi / (double)segments));
    const skg_distance out = between(inner, outer, NULL), back = between(outer, inner, NULL);
    const double values[] = {out.mean_mm,  out.rms_mm,  out.p95_mm,  out.max_mm,
                             back.mean_mm, back.rms_mm, back.p95_mm, back.max_mm};
    for (int i = 0; i < 8; i++) ck_assert_double_eq_tol(values[i], gap, chord);
    const skg_distance none = between(outer, outer, NULL);
    ck_assert_double_le(none.max_mm, 64 * DBL_EPSILON * 60);
    skg_mesh_release(&inner);
    skg_mesh_release(&outer);
}
END_TEST

/* Vertices of a fine part outnumber those of a coarse one; areas do not. The square from 0 to 100 at height 0 is two
 * triangles; beside it, at height 8, as large a square is divided into 40 x 40. */
START_TEST(vertices_are_biased_and_areas_are_not) {
    enum { N = 40 };
    static double p[3 * (4 + (N + 1) * (N + 1))] = {0, 0, 0, 100, 0, 0, 100, 100, 0, 0, 100, 0};
    static int32_t corners[3 * (2 + 2 * N * N)] = {0, 1, 2, 0, 2, 3};
    int64_t vertices = 4, triangles = 2;
    for (int i = 0; i <= N; i++)
        for (int j = 0; j <= N; j++) {
            double *at = p + 3 * vertices++;
            at[0] = 200 + 100.0 * i / N, at[1] = 100.0 * j / N, at[2] = 8;
            if (i == N || j == N) continue;
            const int32_t here = (int32_t)vertices - 1;
            const int32_t cell[] = {here, here + N + 1, here + N + 2, here, here + N + 2, here + 1};
            memcpy(corners + 3 * triangles, cell, sizeof cell);
            triangles += 2;
        }
    skg_mesh *mesh, *low = make_square(-1000, 2000, 0, 0);
    ck_skg(skg_mesh_create(NULL, "two",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = vertices,
                                              .positions = p,
                                              .triangles = triangles,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mesh));
    skg_distance_options options;
    skg_distance_options_init(&options);
    ck_assert_double_eq_tol(between(mesh, low, &options).mean_mm, 4, 1e-9); /* half of 8; rounding of sums */
    options.sampling = SKG_DISTANCE_VERTICES;
    const double expected = 8.0 * (N + 1) * (N + 1) / (4 + (N + 1) * (N + 1));
    ck_assert_double_eq_tol(between(mesh, low, &options).mean_mm, expected, 1e-9); /* rounding of sums */
    skg_mesh_release(&mesh);
    skg_mesh_release(&low);
}
END_TEST

START_TEST(threads_do_not_change_bits) {
    skg_mesh *a, *b;
    ck_skg(skg_mesh_create_sphere(50, 60, &a));
    ck_skg(skg_mesh_create_cylinder(45, 100, 50, &b));
    omp_set_num_threads(1);
    const skg_distance one = between(a, b, NULL);
    omp_set_num_threads(3);
    const skg_distance three = between(a, b, NULL);
    ck_assert_mem_eq(&one, &three, sizeof one);
    skg_mesh_release(&a);
    skg_mesh_release(&b);
}
END_TEST

START_TEST(points_and_maps) {
    skg_mesh *cube, *read;
    const double points[] = {0, 0, 0, 30, 0, 0, 13, 14, 0};
    double distances[3];
    ck_skg(skg_mesh_create_cube(20, &cube));
    ck_skg(skg_distance_of_points(cube, 3, points, distances));
    const double rounding = 64 * DBL_EPSILON * 20;
    ck_assert_double_eq_tol(distances[0], 10, rounding);
    ck_assert_double_eq_tol(distances[1], 20, rounding);
    ck_assert_double_eq_tol(distances[2], 5, rounding);

    char path[] = "/tmp/skg-map-XXXXXX.ply";
    const int file = mkstemps(path, 4);
    ck_assert_int_ge(file, 0);
    close(file);
    int64_t vertices, triangles, its_vertices, its_triangles;
    ck_skg(skg_mesh_count(cube, &vertices, &triangles));
    double map[64];
    for (int64_t i = 0; i < vertices; i++) map[i] = (double)i;
    ck_skg(skg_distance_map_save(cube, map, 5, path));
    ck_skg(skg_mesh_load(NULL, path, 1, &read));
    ck_skg(skg_mesh_count(read, &its_vertices, &its_triangles));
    ck_assert_int_eq(its_vertices, vertices);
    ck_assert_int_eq(its_triangles, triangles);
    const skg_distance same = between(cube, read, NULL);
    ck_assert_double_le(same.max_mm, rounding);
    FILE *stream = fopen(path, "rb");
    char bytes[4096] = "";
    const size_t count = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    const char *end = memmem(bytes, count, "end_header\n", 11);
    ck_assert_ptr_nonnull(end);
    uint8_t rgb[3];
    for (int64_t i = 0; i < vertices; i++) { /* 31 bytes a vertex: position, distance, colour */
        float distance;
        memcpy(&distance, end + 11 + 31 * i + 24, sizeof distance);
        ck_assert_double_eq((double)distance, (double)i);
        ck_skg(skg_distance_colour((double)i / 5, rgb));
        ck_assert_mem_eq(end + 11 + 31 * i + 28, rgb, 3);
    }
    unlink(path);
    skg_mesh_release(&cube);
    skg_mesh_release(&read);
}
END_TEST

START_TEST(colours_brighten_evenly) {
    double last = 0;
    uint8_t rgb[3], end[3];
    for (int i = 0; i <= 100; i++) {
        ck_skg(skg_distance_colour(i / 100.0, rgb));
        const double bright = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; /* Rec. 709 */
        ck_assert_double_gt(bright, last);
        last = bright;
    }
    ck_skg(skg_distance_colour(7, end));
    ck_assert_mem_eq(rgb, end, 3);
    ck_skg(skg_distance_colour((double)NAN, end));
    ck_skg(skg_distance_colour(0, rgb));
    ck_assert_mem_eq(rgb, end, 3);
}
END_TEST

START_TEST(bad_arguments) {
    skg_mesh *cube;
    skg_distance d;
    skg_distance_options options;
    double point[3] = {(double)NAN, 0, 0}, distance;
    ck_skg(skg_mesh_create_cube(20, &cube));
    skg_distance_init(&d);
    skg_distance_options_init(&options);
    ck_skg_fails(skg_distance_measure(NULL, cube, NULL, &d), SKG_ERR_ARGUMENT, "from is NULL");
    ck_skg_fails(skg_distance_measure(cube, cube, NULL, NULL), SKG_ERR_ARGUMENT, "distance is NULL");
    options.spacing_mm = -1;
    ck_skg_fails(skg_distance_measure(cube, cube, &options, &d), SKG_ERR_ARGUMENT, "a spacing of -1 mm");
    options.spacing_mm = 1e-5;
    ck_skg_fails(skg_distance_measure(cube, cube, &options, &d), SKG_ERR_ARGUMENT, "give a larger spacing");
    options.sampling = 2;
    ck_skg_fails(skg_distance_measure(cube, cube, &options, &d), SKG_ERR_ARGUMENT, "sampling");
    ck_skg_fails(skg_distance_of_points(cube, 1, point, &distance), SKG_ERR_ARGUMENT,
                 "point 0 is not finite");
    ck_skg_fails(skg_distance_map_save(cube, point, 0, "/tmp/x.ply"), SKG_ERR_ARGUMENT, "above 0");
    float *offsets;
    const double *origin;
    ck_skg(skg_mesh_offsets_get(cube, &offsets, &origin));
    offsets[3] = NAN;
    (void)skg_mesh_offsets_moved(cube);
    ck_skg_fails(skg_distance_measure(cube, cube, NULL, &d), SKG_ERR_MESH, "vertex 1 is not finite");
    skg_mesh_release(&cube);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, nearest_points_are_those_of_brute_force, 0, 4);
    tcase_add_test(tests, parallel_planes);
    tcase_add_test(tests, a_ramp);
    tcase_add_test(tests, concentric_spheres);
    tcase_add_test(tests, vertices_are_biased_and_areas_are_not);
    tcase_add_test(tests, threads_do_not_change_bits);
    tcase_add_test(tests, points_and_maps);
    tcase_add_test(tests, colours_brighten_evenly);
    tcase_add_test(tests, bad_arguments);
}

SKG_SUITE_MAIN("distance", add_tests)
