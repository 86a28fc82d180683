/* How often a mesh lies over itself. */
#include "mesh/mesh.h"
#include "suite.h"
#include "support/random.h"
#include "support/shapes.h"

#include <math.h>
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

/* Cubes that were side by side are moved onto each other, and apart again. */
START_TEST(layers_are_counted_again_when_vertices_move) {
    enum { COUNT = 9 };
    double apart[24 * COUNT], together[24 * COUNT];
    float *offsets = NULL;
    skg_mesh *mesh = stacked_cubes(COUNT, 16);
    ck_assert_int_eq(mesh->layers, 1);
    ck_assert_int_eq(skg_mesh_layers_unseen(mesh), COUNT);
    ck_skg(skg_mesh_positions_get(mesh, apart, 0));
    for (int i = 0; i < 24 * COUNT; i++) together[i] = apart[i % 24];
    ck_skg(skg_mesh_positions_set(mesh, together, 0));
    ck_assert_int_eq(mesh->layers, COUNT);
    ck_skg(skg_mesh_positions_set(mesh, apart, 0));
    ck_assert_int_eq(mesh->layers, 1);
    ck_skg(skg_mesh_offsets_get(mesh, &offsets, NULL));
    for (int i = 24; i < 24 * COUNT; i++) offsets[i] = offsets[i % 24];
    ck_skg(skg_mesh_offsets_moved(mesh));
    ck_assert_int_eq(mesh->layers, COUNT);
    skg_mesh_release(&mesh);
}
END_TEST

/* The most boxes over one of 32^3 cells of the mesh's bounds, each cell asked in turn. */
static int most_in_a_cell(const skg_mesh *mesh, int count) {
    int from[100][3], to[100][3], most = 0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            const double low = (double)mesh->lowest[k], step = ((double)mesh->highest[k] - low) / 32;
            const double begin = (double)mesh->boxes[6 * i + k], end = (double)mesh->boxes[6 * i + 3 + k];
            from[i][k] = (int)fmin(floor((begin - low) / step), 31);
            to[i][k] = (int)fmin(floor((end - low) / step), 31);
        }
    for (int cell = 0; cell < 32 * 32 * 32; cell++) {
        const int at[3] = {cell % 32, cell / 32 % 32, cell / 1024};
        int here = 0;
        for (int i = 0; i < count; i++) {
            int in = 1;
            for (int k = 0; k < 3; k++) in &= from[i][k] <= at[k] && at[k] <= to[i][k];
            here += in;
        }
        most = here > most ? here : most;
    }
    return most;
}

/* Cubes at random, some of them few, so that both ways of counting are asked. */
START_TEST(layers_of_cubes_at_random) {
    static const int counts[] = {2, 6, 7, 40, 64, 65, 100};
    uint64_t state = 5;
    for (int round = 0; round < 42; round++) {
        const int count = counts[round % 7];
        double one[24], at[24 * 100];
        skg_mesh *mesh = stacked_cubes(count, 16);
        ck_skg(skg_mesh_positions_get(mesh, at, 0));
        memcpy(one, at, sizeof one);
        for (int i = 0; i < count; i++) {
            const double shift[3] = {draw(&state, 0, 4), draw(&state, 0, 4), draw(&state, 0, 4)};
            for (int v = 0; v < 24; v++) at[24 * i + v] = one[v] + shift[v % 3];
        }
        ck_skg(skg_mesh_positions_set(mesh, at, 0));
        ck_assert_int_eq(mesh->layers, most_in_a_cell(mesh, count));
        skg_mesh_release(&mesh);
    }
}
END_TEST

/* One closed component winds up to three times about its middle. */
START_TEST(layers_of_one_component) {
    for (int step = 1; step <= 3; step++) {
        solid s = solid_star(7, step, 15, 16);
        skg_mesh *mesh = NULL;
        ck_skg(skg_mesh_create(NULL, "star",
                               &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                  .vertices = s.vertices,
                                                  .positions = s.positions,
                                                  .triangles = s.triangles,
                                                  .corners = s.corners,
                                                  .unit_mm = 1},
                               &mesh));
        ck_assert_int_eq(mesh->pieces, 1);
        ck_assert_int_eq(mesh->layers, step);
        skg_mesh_release(&mesh);
        solid_free(&s);
    }
}
END_TEST

/* A face of 300,000 corners that is cut into a fan has an edge of as many triangles; with as many boxes the product exceeds 32 bits. */
START_TEST(many_layers_times_many_copies) {
    skg_mesh *mesh = stacked_cubes(100, 1e-3);
    mesh->multiplicity = 300000000;
    ck_skg(skg_mesh_count_layers(mesh));
    ck_assert(mesh->layers == 30000000000);
    skg_mesh_release(&mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, layers_are_counted_again_when_vertices_move);
    tcase_add_test(tests, layers_of_one_component);
    tcase_add_test(tests, many_layers_times_many_copies);
    tcase_add_test(tests, layers_of_cubes_at_random);
    tcase_add_test(tests, layers_count_what_lies_over_each_other);
}

SKG_SUITE_MAIN("mesh layers", add_tests)
