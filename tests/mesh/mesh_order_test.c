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
    ck_skg(skg_mesh_create(NULL, "shuffled", vertices, positions, 0, triangles, given, 0, 1, &shuffled));
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

static void add_tests(TCase *tests) {
    tcase_add_test(tests, shuffled_triangles_are_put_in_order);
}

SKG_SUITE_MAIN("mesh order", add_tests)
