#include "mesh/mesh.h"
#include "suite.h"

#include <string.h>

/* One mesh of `count` unit cubes, each `apart` mm further along z. */
static skg_mesh *stacked_cubes(int count, double apart) {
    skg_mesh *cube = NULL, *all = NULL;
    double *positions = calloc((size_t)count * 24, sizeof *positions);
    int32_t *corners = calloc((size_t)count * 36, sizeof *corners);
    double one[24];
    int32_t one_corners[36];
    int64_t vertices = 0, triangles = 0;
    ck_skg(skg_mesh_create_cube(1, &cube));
    ck_skg(skg_mesh_count(cube, &vertices, &triangles));
    ck_assert_int_eq(vertices, 8);
    ck_assert_int_eq(triangles, 12);
    ck_skg(skg_mesh_positions_get(cube, one, 0));
    ck_skg(skg_mesh_triangles_get(cube, one_corners, 0));
    for (int i = 0; i < count; i++) {
        for (int v = 0; v < 24; v++) positions[24 * i + v] = one[v] + (v % 3 == 2 ? i * apart : 0);
        for (int c = 0; c < 36; c++) corners[36 * i + c] = one_corners[c] + 8 * i;
    }
    ck_skg(skg_mesh_create(NULL, "cubes",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = count * 8,
                                              .positions = positions,
                                              .triangles = count * 12,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &all));
    free(positions);
    free(corners);
    skg_mesh_release(&cube);
    return all;
}

START_TEST(layers_count_what_lies_over_each_other) {
    skg_mesh *mesh = stacked_cubes(1, 0);
    ck_assert_int_eq(mesh->layers, 1);
    skg_mesh_release(&mesh);
    mesh = stacked_cubes(64, 4); /* a laminate: apart, in cells of 7.9 mm, so two or three to a cell */
    ck_assert_int_ge(mesh->layers, 1);
    ck_assert_int_le(mesh->layers, 4);
    skg_mesh_release(&mesh);
    mesh = stacked_cubes(100, 1e-3); /* all over each other, nearly */
    ck_assert_int_eq(mesh->layers, 100);
    skg_mesh_release(&mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, layers_count_what_lies_over_each_other);
}

SKG_SUITE_MAIN("mesh layers", add_tests)
