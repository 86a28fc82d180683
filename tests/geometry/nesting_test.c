/* Components whose orientation contradicts their nesting: boxes in boxes. */
#include "geometry/overlaps.h"
#include "suite.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { BOXES_MAX = 8 };

static const int32_t outward[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

static double positions[24 * BOXES_MAX];
static int32_t corners[36 * BOXES_MAX];
static int64_t boxes;
static skg_mesh *mesh;

/* A box about (x, 0, z) of half edge h; sign -1: its triangles face inward. */
static void add_box(double x, double z, double h, int sign) {
    for (int v = 0; v < 8; v++) {
        double *p = positions + 24 * boxes + 3 * v;
        p[0] = x + (v & 1 ? h : -h), p[1] = v & 2 ? h : -h, p[2] = z + (v & 4 ? h : -h);
    }
    for (int i = 0; i < 36; i++) {
        const int at = i % 3 == 0 ? i : sign > 0 ? i : i % 3 == 1 ? i + 1 : i - 1;
        corners[36 * boxes + i] = outward[at] + (int32_t)(8 * boxes);
    }
    boxes++;
}

static skg_mesh_nesting nesting_of_boxes(void) {
    skg_mesh_nesting nesting;
    skg_mesh_nesting_init(&nesting);
    skg_mesh_release(&mesh);
    ck_skg(skg_mesh_create(NULL, "boxes",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 8 * boxes,
                                              .positions = positions,
                                              .position_stride = 3,
                                              .triangles = 12 * boxes,
                                              .corners = corners,
                                              .triangle_stride = 3,
                                              .unit_mm = 1},
                           &mesh));
    ck_skg(skg_mesh_nesting_get(mesh, &nesting));
    boxes = 0;
    return nesting;
}

static void release(void) {
    skg_mesh_release(&mesh);
}

static double volume_of(const skg_mesh *of) {
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(of, &health));
    return health.volume;
}

START_TEST(what_is_right_is_silent) {
    char text[64] = "x";
    add_box(0, 0, 10, 1);
    ck_assert_int_eq(nesting_of_boxes().components, 1);
    /* A cavity, an island in it, a cavity in that, and a box beside them that touches. */
    add_box(0, 0, 10, 1);
    add_box(0, 0, 8, -1);
    add_box(0, 0, 6, 1);
    add_box(0, 0, 4, -1);
    add_box(19, 0, 9, 1);
    skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.components, 5);
    ck_assert_int_eq(nesting.inverted, 0);
    ck_assert_int_eq(nesting.first_inverted, -1);
    ck_assert_int_eq(nesting.leaving, 0);
    ck_skg(skg_mesh_nesting_describe(&nesting, sizeof text, text));
    ck_assert_str_eq(text, "");
    /* Overlapping boxes are no matter of orientation. */
    add_box(0, 0, 10, 1);
    add_box(12, 0, 8, 1);
    ck_assert_int_eq(nesting_of_boxes().inverted, 0);
}
END_TEST

START_TEST(an_inward_box_in_the_open_is_inverted) {
    char text[512];
    add_box(0, 0, 10, 1);
    add_box(30, 5, 3, -1);
    add_box(0, 0, 5, -1);
    skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.inverted, 1);
    ck_assert_int_eq(nesting.first_inverted, 1);
    ck_assert_int_eq(nesting.inverted_triangles, 12);
    ck_assert_int_eq(nesting.inverted_inward, 1);
    ck_assert_int_eq(nesting.leaving, 0);
    for (int k = 0; k < 3; k++) { /* inside of it */
        const double middle[3] = {30, 0, 5};
        ck_assert(fabs(nesting.inverted_place[k] - middle[k]) < 3);
    }
    ck_skg(skg_mesh_nesting_describe(&nesting, sizeof text, text));
    ck_assert_ptr_nonnull(strstr(text, "1 of 3 components is inverted: number 2 (12 triangles, near ("));
    ck_assert_ptr_nonnull(strstr(text, "faces inward in the open, where lengths become negative"));
    skg_mesh *oriented = NULL;
    ck_skg(skg_mesh_create_oriented(NULL, mesh, &oriented));
    ck_assert_double_eq_tol(volume_of(oriented), 8000 + 216 - 1000,
                            1e-9); /* sums of a few thousand in double */
    ck_skg(skg_mesh_nesting_get(oriented, &nesting));
    ck_assert_int_eq(nesting.inverted, 0);
    skg_mesh_release(&oriented);
}
END_TEST

/* The second shell counts twice; once it is a cavity, what lies inside of it is an island and right as it is. */
START_TEST(an_outward_box_inside_another_is_inverted) {
    add_box(0, 0, 10, 1);
    add_box(0, 0, 8, 1);
    add_box(0, 0, 6, 1);
    skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.inverted, 1);
    ck_assert_int_eq(nesting.first_inverted, 1);
    ck_assert_int_eq(nesting.inverted_inward, 0);
    skg_mesh *oriented = NULL;
    ck_skg(skg_mesh_create_oriented(NULL, mesh, &oriented));
    ck_assert_double_eq_tol(volume_of(oriented), 8000 - 4096 + 1728,
                            1e-9); /* sums of a few thousand in double */
    skg_mesh_release(&oriented);
}
END_TEST

/* All triangles the other way: the mesh is turned as a whole, and the same component contradicts. */
/* Two boxes of which neither lies in the other: 2 of the 8 mm of the smaller one. */
START_TEST(boxes_that_overlap_are_named) {
    char text[512];
    add_box(0, 0, 5, 1);
    add_box(0, 7, 4, 1);
    add_box(0, -20, 5, 1);
    const skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.inverted + nesting.leaving, 0);
    ck_assert_int_eq(nesting.overlapping, 1);
    ck_assert_int_eq(nesting.first_overlapping, 1);
    /* sums of doubles of some mm */
    ck_assert_double_eq_tol(nesting.overlapping_length, 2, 1e-9);
    ck_assert_double_eq_tol(nesting.overlapping_place[2], 4, 1e-9);
    ck_skg(skg_mesh_nesting_describe(&nesting, sizeof text, text));
    ck_assert_ptr_nonnull(strstr(text, "1 of 3 components overlaps a larger one: number 2 by up to 2 mm"));
}
END_TEST

START_TEST(a_flipped_mesh_gives_the_same) {
    add_box(0, 0, 10, -1);
    add_box(0, 0, 8, 1);
    add_box(30, 0, 3, 1);
    skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.inverted, 1);
    ck_assert_int_eq(nesting.first_inverted, 2);
    ck_assert_int_eq(nesting.inverted_inward, 1);
}
END_TEST

/* A cavity from z = 5 to 11 in a box that ends at z = 10: a stretch of 1 mm is negative, and no turn mends it. */
START_TEST(a_cavity_leaves_its_solid) {
    char text[512];
    add_box(0, 0, 10, 1);
    add_box(0, 8, 3, -1);
    skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.inverted, 0);
    ck_assert_int_eq(nesting.leaving, 1);
    ck_assert_int_eq(nesting.first_leaving, 1);
    ck_assert_double_eq_tol(nesting.leaving_length, 1, 1e-12); /* depths of 10 mm in double */
    ck_assert_double_eq_tol(nesting.leaving_place[2], 10.5, 1e-12);
    ck_skg(skg_mesh_nesting_describe(&nesting, sizeof text, text));
    ck_assert_ptr_nonnull(
        strstr(text, "1 of 2 components is a cavity that leaves its solid: number 2 by up to 1 mm"));
    /* Most of it outside: turned, it is a box that overlaps another. */
    add_box(0, 0, 10, 1);
    add_box(0, 12, 3, -1);
    nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.inverted, 1);
    ck_assert_int_eq(nesting.leaving, 0);
}
END_TEST

START_TEST(leaky_meshes_are_not_examined) {
    add_box(0, 0, 10, 1);
    add_box(30, 0, 3, -1);
    corners[71] = corners[69]; /* a triangle collapses */
    skg_mesh_nesting nesting = nesting_of_boxes();
    ck_assert_int_eq(nesting.components, 0);
    ck_assert_int_eq(nesting.inverted, 0);
    ck_skg_fails(skg_mesh_nesting_get(NULL, &nesting), SKG_ERR_ARGUMENT, "mesh");
    ck_skg_fails(skg_mesh_nesting_get(mesh, NULL), SKG_ERR_ARGUMENT, "nesting");
    ck_skg_fails(skg_mesh_create_oriented(NULL, mesh, NULL), SKG_ERR_ARGUMENT, "oriented");
    ck_skg_fails(skg_mesh_nesting_describe(&nesting, 0, (char[1]){0}), SKG_ERR_ARGUMENT, "0 bytes");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, NULL, release);
    tcase_add_test(tests, what_is_right_is_silent);
    tcase_add_test(tests, an_inward_box_in_the_open_is_inverted);
    tcase_add_test(tests, an_outward_box_inside_another_is_inverted);
    tcase_add_test(tests, boxes_that_overlap_are_named);
    tcase_add_test(tests, a_flipped_mesh_gives_the_same);
    tcase_add_test(tests, a_cavity_leaves_its_solid);
    tcase_add_test(tests, leaky_meshes_are_not_examined);
}

SKG_SUITE_MAIN("nesting", add_tests)
