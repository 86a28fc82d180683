/* Duplicate triangles: not the common wall of two bodies, nor what has no area. */
#include "mesh/mesh.h"
#include "mesh/mesh_files.h"

#include <float.h>

/* Unit cubes side by side along z: vertices in three layers of four. */
#define LAYERS                                                                                               \
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\nv 0 0 2\nv 1 0 2\nv 0 1 2\nv 1 1 2\n"
#define LOWER "f 1 3 4\nf 1 4 2\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n"
#define LOWER_WALL "f 5 6 8\nf 5 8 7\n"
#define UPPER_WALL "f 5 7 8\nf 5 8 6\n"
#define UPPER                                                                                                \
    "f 9 10 12\nf 9 12 11\nf 5 6 10\nf 5 10 9\nf 7 11 12\nf 7 12 8\nf 5 9 11\nf 5 11 7\nf 6 8 12\nf 6 12 10\n"
#define INWARD                                                                                               \
    "f 1 4 3\nf 1 2 4\nf 1 6 2\nf 1 5 6\nf 3 8 7\nf 3 4 8\nf 1 7 5\nf 1 3 7\nf 2 8 4\nf 2 6 8\n" UPPER_WALL

START_TEST(duplicates_count) {
    static const struct {
        const char *text;
        int64_t duplicates;
        int32_t closed;
        double volume;
    } files[] = {{LAYERS LOWER LOWER_WALL UPPER_WALL UPPER, 0, 1, 2},             /* a common wall */
                 {LAYERS LOWER LOWER_WALL LOWER LOWER_WALL, 12, 1, 2},            /* a cube twice */
                 {LAYERS LOWER LOWER_WALL INWARD, 12, 1, 0},                      /* and once inward */
                 {LAYERS LOWER LOWER_WALL UPPER_WALL, 2, 0, 1},                   /* a wall of no body */
                 {LAYERS LOWER LOWER_WALL UPPER_WALL UPPER_WALL UPPER, 4, 0, 2}}; /* three times */
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        skg_mesh *mesh = NULL;
        skg_mesh_reading reading;
        skg_mesh_reading_init(&reading);
        reading.as_wound = 1;
        ck_skg(skg_mesh_load_as(NULL, file_of("a.obj", files[f].text), &reading, &mesh));
        const skg_mesh_health health = health_of(mesh);
        ck_assert_msg(health.duplicate_triangles == files[f].duplicates, "file %zu: %lld", f,
                      (long long)health.duplicate_triangles);
        ck_assert_int_eq(health.closed, files[f].closed);
        if (health.closed) ck_assert_double_eq_tol(health.volume, files[f].volume, 16 * DBL_EPSILON);
        skg_mesh_release(&mesh);
    }
}
END_TEST

/* Two polygons with a vertex on their common edge: its flat triangle is made of each. */
START_TEST(flat_triangles_are_no_duplicates) {
    skg_mesh *mesh =
        load(file_of("a.obj", "v 0 0 0\nv 10 0 0\nv 0 20 0\nv 10 20 0\nv 0 0 30\nv 10 0 30\nv 0 20 30\n"
                              "v 10 20 30\nv 5 0 0\nf 1 3 4 2 9\nf 5 6 8 7\nf 1 9 2 6 5\nf 3 7 8 4\n"
                              "f 1 5 7 3\nf 2 4 8 6\n"));
    ck_assert_int_eq(health_of(mesh).degenerate_triangles, 2);
    ck_assert_int_eq(health_of(mesh).duplicate_triangles, 0);
    skg_mesh_release(&mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, make_folder, remove_folder);
    tcase_add_test(tests, duplicates_count);
    tcase_add_test(tests, flat_triangles_are_no_duplicates);
}

SKG_SUITE_MAIN("duplicates", add_tests)
