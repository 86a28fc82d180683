/* Triangles in an order that memory likes. */
#include "core/core.h"
#include "mesh/mesh.h"
#include "suite.h"

#include <stdlib.h>
#include <string.h>

/* Random numbers (Knuth's MMIX generator): the same ones in every run. */
static uint64_t seed = 1;
static int64_t draw(int64_t below) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int64_t)((seed >> 33) % (uint64_t)below);
}

static int compare_triangles(const void *a, const void *b) {
    return memcmp(a, b, 3 * sizeof(int32_t));
}

START_TEST(shuffled_triangles_are_put_in_order) {
    skg_mesh *sphere, *shuffled;
    int64_t vertices, triangles;
    int32_t sorted, *corners, *given;
    double *positions;
    ck_skg(skg_mesh_create_sphere(100, 128, &sphere));
    ck_skg(skg_mesh_count(sphere, &vertices, &triangles));
    ck_skg(skg_alloc(3 * vertices, sizeof *positions, "test", &positions));
    ck_skg(skg_alloc(3 * triangles, sizeof *corners, "test", &corners));
    ck_skg(skg_alloc(3 * triangles, sizeof *given, "test", &given));
    ck_skg(skg_mesh_positions_get(sphere, positions, 0));
    ck_skg(skg_mesh_triangles_get(sphere, given, 0));
    ck_skg(skg_mesh_sorted_corners(sphere, corners, &sorted));
    ck_assert_int_eq(sorted, 0); /* rings are good enough */
    ck_assert_mem_eq(corners, given, 3 * (size_t)triangles * sizeof *given);
    for (int64_t i = triangles - 1; i > 0; i--) {
        int64_t j = draw(i + 1);
        for (int k = 0; k < 3; k++) {
            int32_t swap = given[3 * i + k];
            given[3 * i + k] = given[3 * j + k], given[3 * j + k] = swap;
        }
    }
    ck_skg(skg_mesh_create(NULL, "shuffled",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = vertices,
                                              .positions = positions,
                                              .triangles = triangles,
                                              .corners = given,
                                              .unit_mm = 1},
                           &shuffled));
    ck_skg(skg_mesh_sorted_corners(shuffled, corners, &sorted));
    ck_assert_int_eq(sorted, 1);
    double step = 0; /* mean distance of first corners, in a mesh with edges of some 5 mm */
    for (int64_t i = 1; i < triangles; i++)
        step += fabs(positions[3 * corners[3 * i]] - positions[3 * corners[3 * i - 3]]) / (double)triangles;
    ck_assert_double_lt(step, 5);
    qsort(corners, (size_t)triangles, 3 * sizeof *corners, compare_triangles);
    qsort(given, (size_t)triangles, 3 * sizeof *given, compare_triangles);
    ck_assert_mem_eq(corners, given, 3 * (size_t)triangles * sizeof *given);
    skg_free(&positions);
    skg_free(&corners);
    skg_free(&given);
    skg_mesh_release(&sphere);
    skg_mesh_release(&shuffled);
}
END_TEST

/* Every triangle of a layout has the corners of a triangle of the mesh, at the same places. */
static void check_places(const skg_mesh *mesh, const skg_mesh_layout *layout) {
    for (int64_t c = 0; c < 3 * mesh->triangles; c++) {
        const int32_t v = layout->source ? layout->source[layout->corners[c]] : layout->corners[c];
        ck_assert_mem_eq(mesh->positions + 3 * (int64_t)v, mesh->positions + 3 * (int64_t)mesh->corners[c],
                         3 * sizeof(double));
    }
    for (int64_t i = 0; layout->source && i < layout->vertices + layout->copies; i++)
        ck_assert(layout->source[i] >= 0 && layout->source[i] < mesh->vertices);
}

/* A sphere whose triangles share no vertices; `less` of them are missing. */
static skg_mesh *make_soup(int64_t segments, int64_t less) {
    skg_mesh *sphere, *soup;
    ck_skg(skg_mesh_create_sphere(100, segments, &sphere));
    const int64_t triangles = sphere->triangles - less;
    double *positions;
    int32_t *corners;
    ck_skg(skg_alloc(9 * triangles, sizeof *positions, "test", &positions));
    ck_skg(skg_alloc(3 * triangles, sizeof *corners, "test", &corners));
    for (int64_t c = 0; c < 3 * triangles; c++) {
        memcpy(positions + 3 * c, sphere->positions + 3 * (int64_t)sphere->corners[c], 3 * sizeof *positions);
        corners[c] = (int32_t)c;
    }
    ck_skg(skg_mesh_create(NULL, "soup",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 3 * triangles,
                                              .positions = positions,
                                              .triangles = triangles,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &soup));
    skg_free(&positions);
    skg_free(&corners);
    skg_mesh_release(&sphere);
    return soup;
}

START_TEST(vertices_at_one_place_are_one_on_the_device) {
    skg_mesh *soup = make_soup(16, 0);
    skg_mesh_layout layout;
    ck_skg(skg_mesh_layout_create(soup, &layout));
    ck_assert_int_eq(layout.vertices, soup->health.welded_vertices);
    ck_assert_int_eq(layout.copies, 0);
    check_places(soup, &layout);
    for (int64_t i = 0; i < layout.vertices; i++) /* the first vertex of the caller at each place */
        ck_assert_int_eq(soup->weld[layout.source[i]], layout.source[i]);
    skg_mesh_layout_release(&layout);
    skg_mesh_release(&soup);
}
END_TEST

START_TEST(those_of_a_leaky_mesh_may_part) {
    skg_mesh *soup = make_soup(16, 2);
    skg_mesh_layout layout;
    ck_skg(skg_mesh_layout_create(soup, &layout));
    ck_assert_int_eq(layout.vertices, soup->health.welded_vertices);
    ck_assert_int_eq(layout.vertices + layout.copies, soup->vertices);
    check_places(soup, &layout);
    skg_free(&layout.corners);
    ck_skg(skg_mesh_layout_part(soup, &layout));
    ck_assert_int_eq(layout.vertices, soup->vertices);
    ck_assert_int_eq(layout.copies, 0);
    for (int64_t c = 0; c < 3 * soup->triangles; c++) /* each is the caller's own */
        ck_assert_int_eq(layout.source[layout.corners[c]], soup->corners[c]);
    ck_assert_int_eq(skg_mesh_parted(soup), -1);
    soup->positions[3 * 7] += 1;
    ck_assert_int_ne(skg_mesh_parted(soup), -1);
    skg_mesh_layout_release(&layout);
    skg_mesh_release(&soup);
}
END_TEST

/* A tidy mesh is copied as it is. The same mesh with its vertices in any order is not: they follow the triangles. */
START_TEST(vertices_follow_the_triangles) {
    skg_mesh *sphere, *mixed;
    skg_mesh_layout layout;
    ck_skg(skg_mesh_create_sphere(100, 128, &sphere));
    ck_skg(skg_mesh_layout_create(sphere, &layout));
    ck_assert_ptr_null(layout.source);
    ck_assert_int_eq(layout.vertices, sphere->vertices);
    check_places(sphere, &layout);
    skg_mesh_layout_release(&layout);
    const int64_t vertices = sphere->vertices;
    int32_t *to, *corners;
    double *positions;
    ck_skg(skg_alloc(vertices, sizeof *to, "test", &to));
    ck_skg(skg_alloc(3 * vertices, sizeof *positions, "test", &positions));
    ck_skg(skg_alloc(3 * sphere->triangles, sizeof *corners, "test", &corners));
    for (int32_t v = 0; v < vertices; v++) to[v] = v;
    for (int64_t v = vertices - 1; v > 0; v--) {
        const int64_t other = draw(v + 1);
        const int32_t swap = to[v];
        to[v] = to[other], to[other] = swap;
    }
    for (int64_t v = 0; v < vertices; v++)
        memcpy(positions + 3 * (int64_t)to[v], sphere->positions + 3 * v, 3 * sizeof *positions);
    for (int64_t c = 0; c < 3 * sphere->triangles; c++) corners[c] = to[sphere->corners[c]];
    ck_skg(skg_mesh_create(NULL, "mixed",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = vertices,
                                              .positions = positions,
                                              .triangles = sphere->triangles,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mixed));
    ck_skg(skg_mesh_layout_create(mixed, &layout));
    ck_assert_ptr_nonnull(layout.source);
    ck_assert_int_eq(layout.vertices, vertices);
    check_places(mixed, &layout);
    for (int64_t c = 0, seen = 0; c < 3 * mixed->triangles;
         c++) { /* a number is at most one above those before */
        ck_assert_int_le(layout.corners[c], seen);
        seen += layout.corners[c] == seen;
    }
    skg_mesh_layout_release(&layout);
    skg_free(&to);
    skg_free(&positions);
    skg_free(&corners);
    skg_mesh_release(&mixed);
    skg_mesh_release(&sphere);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, shuffled_triangles_are_put_in_order);
    tcase_add_test(tests, vertices_at_one_place_are_one_on_the_device);
    tcase_add_test(tests, those_of_a_leaky_mesh_may_part);
    tcase_add_test(tests, vertices_follow_the_triangles);
}

SKG_SUITE_MAIN("mesh order", add_tests)
