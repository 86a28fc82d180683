/* Which meshes have flat faces: only their edges are moved where parts touch (docs/numerics.md). */
#include "mesh/mesh.h"
#include "suite.h"
#include "support/random.h"

#include <skiagraph/bodies.h>
#include <skiagraph/mesh.h>

#include <math.h>

static int is_flat(skg_mesh *mesh) {
    const int flat = skg_mesh_flat_faces(mesh, NULL);
    skg_mesh_release(&mesh);
    return flat;
}

START_TEST(bodies_with_faces_are_flat) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cube(10, &mesh));
    ck_assert_int_eq(is_flat(mesh), 1);
    ck_skg(skg_mesh_create_cylinder(1, 50, 4096, &mesh)); /* its caps are fans of narrow triangles */
    ck_assert_int_eq(is_flat(mesh), 1);
}
END_TEST

START_TEST(smooth_bodies_are_not) {
    static const double centres[6] = {0, 0, 0, 5, 0, 0}, radii[2] = {1, 2};
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_sphere(10, 64, &mesh));
    ck_assert_int_eq(is_flat(mesh), 0);
    ck_skg(skg_mesh_create_spheres(2, centres, radii, 64, &mesh));
    ck_assert_int_eq(is_flat(mesh), 0);
}
END_TEST

enum { SIDE = 40, ROW = SIDE + 1, VERTICES = 6 * ROW * ROW, TRIANGLES = 12 * SIDE * SIDE };
static double positions[3 * VERTICES];
static int32_t corners[3 * TRIANGLES];

/* A block of 30 x 40 x 50 mm, each face cut into 2 * SIDE^2 triangles, bulged by `bulge` mm. Corners of it turn by 0.3 about z and
 * are rounded to floats, as an STL has them. */
static void fill_block(double bulge) {
    static const double half[3] = {15, 20, 25};
    int32_t vertex = 0, triangle = 0;
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, side = face % 2 ? 1 : -1;
        const int32_t first = vertex;
        for (int r = 0; r < ROW; r++)
            for (int c = 0; c < ROW; c++) {
                const double a = 2.0 * r / SIDE - 1, b = 2.0 * c / SIDE - 1;
                double p[3];
                p[axis] = side * (half[axis] + bulge * (1 - a * a) * (1 - b * b));
                p[u] = a * half[u], p[v] = b * half[v];
                positions[3 * vertex] = (double)(float)(p[0] * cos(0.3) - p[1] * sin(0.3));
                positions[3 * vertex + 1] = (double)(float)(p[0] * sin(0.3) + p[1] * cos(0.3));
                positions[3 * vertex++ + 2] = (double)(float)p[2];
            }
        for (int r = 0; r < SIDE; r++)
            for (int c = 0; c < SIDE; c++) {
                const int32_t at = first + r * ROW + c, right = side > 0 ? at + ROW : at + 1;
                const int32_t below = side > 0 ? at + 1 : at + ROW;
                const int32_t two[6] = {at, right, at + ROW + 1, at, at + ROW + 1, below};
                for (int k = 0; k < 6; k++) corners[3 * triangle + k] = two[k];
                triangle += 2;
            }
    }
}

static skg_mesh *make(void) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create(NULL, "block",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = VERTICES,
                                              .positions = positions,
                                              .triangles = TRIANGLES,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mesh));
    return mesh;
}

/* Each triangle is 1 / 19200 of the surface: only together are they a face. */
START_TEST(many_small_triangles_in_a_plane_are_a_face) {
    fill_block(0);
    ck_assert_int_eq(is_flat(make()), 1);
    fill_block(1);
    ck_assert_int_eq(is_flat(make()), 0);
}
END_TEST

/* Said in mesh.h and docs/numerics.md. */
START_TEST(scattered_triangles_are_not_found) {
    uint64_t state = 7;
    fill_block(0);
    for (int32_t t = TRIANGLES - 1; t > 0; t--) {
        const int64_t other = draw_below(&state, t + 1);
        for (int k = 0; k < 3; k++) {
            const int32_t swap = corners[3 * t + k];
            corners[3 * t + k] = corners[3 * other + k];
            corners[3 * other + k] = swap;
        }
    }
    ck_assert_int_eq(is_flat(make()), 0);
}
END_TEST

START_TEST(nothing_and_flat_sheets_are_no_trap) {
    static const double thin[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
    static const int32_t line[3] = {0, 1, 2};
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create(NULL, "line",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 3,
                                              .positions = thin,
                                              .triangles = 1,
                                              .corners = line,
                                              .unit_mm = 1},
                           &mesh)); /* no area at all */
    ck_assert_int_eq(is_flat(mesh), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, bodies_with_faces_are_flat);
    tcase_add_test(tests, smooth_bodies_are_not);
    tcase_add_test(tests, many_small_triangles_in_a_plane_are_a_face);
    tcase_add_test(tests, scattered_triangles_are_not_found);
    tcase_add_test(tests, nothing_and_flat_sheets_are_no_trap);
}

SKG_SUITE_MAIN("flat", add_tests)
