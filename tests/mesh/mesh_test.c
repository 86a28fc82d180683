/* Meshes from arrays: numbering, health, moving. */
#include "core/context.h"
#include "mesh/mesh.h"
#include "mesh/mesh_health.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The linker sends the library's warnings here (--wrap), so that no device is needed. */
static char last_warning[1024];
void __wrap_skg_log(skg_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void __wrap_skg_log(skg_context *context, int32_t level, const char *format, ...) {
    (void)context, (void)level;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(last_warning, sizeof last_warning, format, arguments);
    va_end(arguments);
}

/* Random numbers (Knuth's MMIX generator): the same ones in every run. */
static uint64_t seed = 1;
static int64_t draw(int64_t below) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int64_t)((seed >> 33) % (uint64_t)below);
}

/* Arrays of a cube for the tests to damage. */
static double cube_positions[8 * 3];
static int32_t cube_corners[12 * 3];
static void take_cube(void) {
    skg_mesh *mesh;
    ck_skg(skg_mesh_create_cube(2, &mesh));
    ck_skg(skg_mesh_positions_get(mesh, cube_positions, 0));
    ck_skg(skg_mesh_triangles_get(mesh, cube_corners, 0));
    skg_mesh_release(&mesh);
}

static int32_t as_wound;
static skg_mesh *make(int64_t vertices, const double *positions, int64_t triangles, const int32_t *corners) {
    skg_mesh *mesh;
    ck_skg(skg_mesh_create(NULL, "thing",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .as_wound = as_wound,
                                              .vertices = vertices,
                                              .positions = positions,
                                              .triangles = triangles,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mesh));
    return mesh;
}

START_TEST(numbering_strides_and_units_are_the_callers) {
    float positions[8 * 5];
    int32_t corners[12 * 4], corners_back[12 * 4];
    double back[8 * 4];
    take_cube();
    for (int i = 0; i < 40; i++) positions[i] = NAN; /* what lies between the rows is not read */
    for (int i = 0; i < 48; i++) corners[i] = -7, corners_back[i] = 99;
    for (int i = 0; i < 24; i++) positions[i / 3 * 5 + i % 3] = (float)cube_positions[i] + 0.25F;
    for (int i = 0; i < 36; i++) corners[i / 3 * 4 + i % 3] = cube_corners[i];
    skg_mesh *mesh;
    ck_skg(skg_mesh_create(NULL, NULL,
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 8,
                                              .floats = positions,
                                              .position_stride = 5,
                                              .triangles = 12,
                                              .corners = corners,
                                              .triangle_stride = 4,
                                              .unit_mm = 10},
                           &mesh));
    const char *name;
    ck_skg(skg_mesh_name_get(mesh, &name));
    ck_assert_str_eq(name, "mesh");
    int64_t vertices, triangles;
    ck_skg(skg_mesh_count(mesh, &vertices, &triangles));
    ck_assert_int_eq(vertices, 8);
    ck_assert_int_eq(triangles, 12);
    ck_skg(skg_mesh_positions_get(mesh, back, 4));
    ck_skg(skg_mesh_triangles_get(mesh, corners_back, 4));
    for (int i = 0; i < 24; i++) ck_assert_double_eq(back[i / 3 * 4 + i % 3], 10 * cube_positions[i] + 2.5);
    for (int i = 0; i < 36; i++) ck_assert_int_eq(corners_back[i / 3 * 4 + i % 3], cube_corners[i]);
    for (int i = 3; i < 48; i += 4) ck_assert_int_eq(corners_back[i], 99);
    ck_skg(skg_mesh_retain(mesh));
    skg_mesh *other = mesh;
    skg_mesh_release(&mesh);
    ck_assert_double_eq_tol(health_of(other).volume, 8000, 8000 * 12 * DBL_EPSILON); /* a sum of 12 */
    skg_mesh_release(&other);
}
END_TEST

START_TEST(missing_triangle_leaves_three_open_edges) {
    take_cube();
    skg_mesh *mesh = make(8, cube_positions, 11, cube_corners);
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.closed, 0);
    ck_assert_int_eq(health.outward, 0);
    ck_assert_int_eq(health.open_edges, 3);
    const int32_t *lost = cube_corners + 33;
    int64_t first = health.first_open_vertex;
    ck_assert(first == lost[0] || first == lost[1] || first == lost[2]);
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq(health.first_open_position[k], cube_positions[3 * first + k]);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(inverted_cube_is_turned_with_a_warning) {
    int32_t corners[36], back[36];
    take_cube();
    for (int i = 0; i < 36; i++) corners[i] = cube_corners[i / 3 * 3 + 2 - i % 3];
    skg_mesh *mesh = make(8, cube_positions, 12, corners);
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.flipped, 1);
    ck_assert_int_eq(health.outward, 1);
    ck_assert_double_eq(health.volume, 8);
    ck_assert_int_eq(mesh->orientation, -1);
    ck_assert_ptr_nonnull(strstr(last_warning, "thing: inverted"));
    ck_skg(skg_mesh_triangles_get(mesh, back, 0));
    ck_assert_mem_eq(back, corners, sizeof corners);
    ck_skg(skg_mesh_positions_set(mesh, cube_positions, 0));
    ck_assert_double_eq(health_of(mesh).volume, 8); /* still as turned */
    skg_mesh_release(&mesh);
}
END_TEST

/* Corner by corner, as STL has it; half of the zeros negative. */
static void make_soup(double *soup, int32_t *corners) {
    take_cube();
    for (int i = 0; i < 36; i++) {
        corners[i] = i;
        for (int k = 0; k < 3; k++) {
            double x = cube_positions[3 * cube_corners[i] + k] + 1;
            soup[3 * i + k] = x == 0 && i % 2 ? -0.0 : x;
        }
    }
}

START_TEST(equal_positions_are_welded_for_the_health) {
    double soup[36 * 3];
    int32_t corners[36];
    make_soup(soup, corners);
    skg_mesh *mesh = make(36, soup, 12, corners);
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.vertices, 36);
    ck_assert_int_eq(health.welded_vertices, 8);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.components, 1);
    ck_assert_double_eq(health.volume, 8);
    /* Moved together it stays closed; moved apart it would open. */
    for (int i = 0; i < 36 * 3; i++) soup[i] *= 3;
    ck_skg(skg_mesh_positions_set(mesh, soup, 0));
    soup[3 * 35] += 1e-9;
    ck_skg_fails(skg_mesh_positions_set(mesh, soup, 0), SKG_ERR_MESH, "and 35 were at the same place");
    ck_assert_double_eq(health_of(mesh).volume, 8 * 27);
    float *offsets;
    ck_skg(skg_mesh_offsets_get(mesh, &offsets, NULL));
    offsets[3 * 35] += 1;
    ck_skg_fails(skg_mesh_offsets_moved(mesh), SKG_ERR_MESH, "move them together");
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(faults_are_counted) {
    int32_t corners[16 * 3];
    take_cube();
    memcpy(corners, cube_corners, sizeof cube_corners);
    const int32_t more[] = {cube_corners[1],
                            cube_corners[2],
                            cube_corners[0], /* repeats 0, another start */
                            cube_corners[5],
                            cube_corners[4],
                            cube_corners[3], /* repeats 1, inverted */
                            0,
                            0,
                            1, /* two corners are one */
                            0,
                            8,
                            7}; /* on a diagonal: no area */
    double positions[27];
    memcpy(positions, cube_positions, sizeof cube_positions);
    positions[24] = positions[25] = positions[26] = 0.25;
    memcpy(corners + 36, more, sizeof more);
    skg_mesh *mesh = make(9, positions, 16, corners);
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.duplicate_triangles, 2);
    ck_assert_int_eq(health.degenerate_triangles, 2);
    ck_assert_int_eq(health.consistent, 0);
    ck_assert_int_eq(health.closed, 0);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(cubes_that_share_an_edge_are_closed) {
    double positions[16 * 3];
    int32_t corners[24 * 3];
    take_cube();
    for (int i = 0; i < 24; i++) {
        positions[i] = cube_positions[i];
        positions[24 + i] = cube_positions[i] + (i % 3 < 2 ? 2 : 0);
    }
    for (int i = 0; i < 36; i++) corners[i] = cube_corners[i], corners[36 + i] = cube_corners[i] + 8;
    skg_mesh *mesh = make(16, positions, 24, corners);
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.nonmanifold_edges, 1);
    ck_assert_int_eq(health.welded_vertices, 14);
    ck_assert_int_eq(health.components, 1);
    ck_assert_double_eq(health.volume, 16);
    skg_mesh_release(&mesh);
}
END_TEST

/* Against counting by brute force: random triangles over few places, some of them at the same position. */
enum { PLACES = 9, FACES = 14 };
static void brute_health(const int32_t *place, const int32_t *corners, skg_mesh_health *brute) {
    int edges[PLACES][PLACES] = {{0}}, group[PLACES];
    for (int i = 0; i < PLACES; i++) group[i] = -1;
    for (int t = 0; t < FACES; t++) {
        int a[3];
        for (int k = 0; k < 3; k++) a[k] = place[corners[3 * t + k]];
        for (int k = 0; k < 3; k++)
            if (group[a[k]] < 0) group[a[k]] = a[k];
        for (int k = 0; k < 2; k++)
            for (int i = 0, from = group[a[k + 1]], to = group[a[0]]; i < PLACES; i++)
                if (group[i] == from) group[i] = to;
        if (a[0] == a[1] || a[1] == a[2] || a[2] == a[0]) continue;
        for (int k = 0; k < 3; k++) edges[a[k]][a[(k + 1) % 3]]++;
        int repeats = 0;
        for (int s = 0; s < t; s++) {
            int same = 0, used[3] = {0};
            for (int k = 0; k < 3; k++)
                for (int j = 0; j < 3; j++)
                    if (!used[j] && a[k] == place[corners[3 * s + j]]) {
                        used[j] = 1, same++;
                        break;
                    }
            repeats |= same == 3;
        }
        brute->duplicate_triangles += repeats;
    }
    brute->consistent = 1;
    for (int i = 0; i < PLACES; i++) {
        brute->components += group[i] == i;
        for (int j = 0; j < PLACES; j++) {
            if (edges[i][j] > edges[j][i]) brute->open_edges += edges[i][j] - edges[j][i];
            if (edges[i][j] > 1) brute->consistent = 0;
            if (i < j) brute->nonmanifold_edges += edges[i][j] + edges[j][i] > 2;
        }
    }
}

START_TEST(health_agrees_with_brute_force) {
    for (int round = 0; round < 500; round++) {
        double positions[PLACES * 3];
        int32_t place[PLACES], corners[FACES * 3];
        for (int32_t i = 0; i < PLACES; i++) {
            place[i] = draw(3) ? i : (int32_t)draw(i + 1);
            place[i] = place[place[i]];
            for (int k = 0; k < 3; k++)
                positions[3 * i + k] = place[i] == i ? (double)draw(1000000) : positions[3 * place[i] + k];
        }
        for (int i = 0; i < FACES * 3; i++) corners[i] = (int32_t)draw(PLACES);
        skg_mesh_health brute = {0};
        brute_health(place, corners, &brute);
        as_wound = 1;
        skg_mesh *mesh = make(PLACES, positions, FACES, corners);
        as_wound = 0;
        skg_mesh_health health = health_of(mesh);
        ck_assert_int_eq(health.open_edges, brute.open_edges);
        ck_assert_int_eq(health.closed, brute.open_edges == 0);
        ck_assert_int_eq(health.nonmanifold_edges, brute.nonmanifold_edges);
        ck_assert_int_eq(health.duplicate_triangles, brute.duplicate_triangles);
        ck_assert_int_eq(health.components, brute.components);
        ck_assert_int_eq(health.consistent, brute.consistent);
        skg_mesh_release(&mesh);
    }
}
END_TEST

START_TEST(mirrored_positions_turn_a_closed_mesh) {
    double positions[24];
    take_cube();
    skg_mesh *mesh = make(8, cube_positions, 12, cube_corners);
    const int32_t flipped = health_of(mesh).flipped;
    for (int i = 0; i < 24; i++) positions[i] = (i % 3 == 0 ? -1 : 1) * cube_positions[i];
    ck_skg(skg_mesh_positions_set(mesh, positions, 0));
    ck_assert_double_eq(health_of(mesh).volume, 8);
    ck_assert_int_eq(health_of(mesh).flipped, !flipped);
    ck_skg(skg_mesh_positions_set(mesh, cube_positions, 0));
    ck_assert_double_eq(health_of(mesh).volume, 8);
    ck_assert_int_eq(health_of(mesh).flipped, flipped);
    skg_mesh_release(&mesh);
    /* Of a mesh with a hole nobody knows what is inside. */
    mesh = make(8, cube_positions, 11, cube_corners);
    ck_skg(skg_mesh_positions_set(mesh, positions, 0));
    ck_assert_int_eq(health_of(mesh).flipped, 0);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(far_mesh_keeps_its_volume_and_offsets) {
    double positions[24];
    take_cube();
    for (int i = 0; i < 24; i++) positions[i] = cube_positions[i] + 1048576; /* exact */
    skg_mesh *mesh = make(8, positions, 12, cube_corners);
    ck_assert_double_eq(health_of(mesh).volume, 8);
    float *offsets, lowest[3], highest[3];
    const double *origin;
    int64_t bad;
    ck_skg(skg_mesh_offsets_get(mesh, &offsets, &origin));
    for (int i = 0; i < 24; i++) ck_assert(offsets[i] == (float)cube_positions[i]);
    for (int k = 0; k < 3; k++) ck_assert_double_eq(origin[k], 1048576);
    /* Moved a little: the origin stays. Far: it follows. */
    positions[0] += 0.5;
    ck_skg(skg_mesh_positions_set(mesh, positions, 0));
    ck_assert_double_eq(origin[0], 1048576);
    for (int i = 0; i < 24; i++) positions[i] = cube_positions[i] + 0.125;
    ck_skg(skg_mesh_positions_set(mesh, positions, 0));
    ck_assert_double_eq(origin[0], 0.125);
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    ck_assert(lowest[0] == -1 && highest[2] == 1 && bad == -1);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(moving_in_place) {
    skg_mesh *mesh;
    float *offsets, lowest[3], highest[3];
    const double *origin;
    int64_t version, bad;
    double positions[24];
    ck_skg(skg_mesh_create_cube(2, &mesh));
    ck_skg(skg_mesh_version_get(mesh, &version));
    ck_assert_int_eq(version, 1);
    ck_skg(skg_mesh_offsets_get(mesh, &offsets, &origin));
    for (int i = 0; i < 24; i++) offsets[i] *= 2;
    ck_skg(skg_mesh_offsets_moved(mesh));
    ck_skg(skg_mesh_version_get(mesh, &version));
    ck_assert_int_eq(version, 2);
    skg_mesh_health health = health_of(mesh);
    ck_assert_double_eq(health.volume, 64);
    ck_assert_double_eq(health.area, 96);
    ck_assert_double_eq(health.bounds[0], -2);
    ck_assert_int_eq(health.closed, 1);
    ck_skg(skg_mesh_positions_get(mesh, positions, 0));
    for (int i = 0; i < 24; i++) ck_assert_double_eq(fabs(positions[i]), 2);
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    ck_assert(lowest[1] == -2 && highest[1] == 2 && bad == -1);
    offsets[3 * 5 + 1] = INFINITY;
    offsets[3 * 6] = NAN;
    ck_skg(skg_mesh_offsets_moved(mesh));
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    ck_assert(lowest[1] == -2 && highest[1] == 2 && bad == 5);
    ck_skg_fails(skg_mesh_save(mesh, "never.ply"), SKG_ERR_MESH, "vertex 5 is not finite");
    ck_skg(skg_mesh_positions_set(mesh, positions, 0)); /* mended */
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    ck_assert_int_eq(bad, -1);
    ck_assert_double_eq(health_of(mesh).volume, 64);
    positions[3 * 4 + 2] = (double)NAN;
    ck_skg_fails(skg_mesh_positions_set(mesh, positions, 0), SKG_ERR_MESH, "vertex 4");
    ck_skg(skg_mesh_version_get(mesh, &version));
    ck_assert_int_eq(version, 4);
    ck_assert_double_eq(health_of(mesh).volume, 64);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(bad_arrays_are_named) {
    skg_mesh *mesh = NULL;
    double p[24];
    int32_t c[36];
    take_cube();
    memcpy(p, cube_positions, sizeof p);
    memcpy(c, cube_corners, sizeof c);
#define CREATE(points, ps, faces, cs, unit)                                                                  \
    skg_mesh_create(NULL, "liver",                                                                           \
                    &(skg_mesh_source){.size = sizeof(skg_mesh_source),                                      \
                                       .vertices = points,                                                   \
                                       .positions = p,                                                       \
                                       .position_stride = ps,                                                \
                                       .triangles = faces,                                                   \
                                       .corners = c,                                                         \
                                       .triangle_stride = cs,                                                \
                                       .unit_mm = unit},                                                     \
                    &mesh)
    ck_skg_fails(CREATE(8, 0, 0, 0, 1), SKG_ERR_MESH, "liver: no triangles");
    ck_skg_fails(CREATE(0, 0, 12, 0, 1), SKG_ERR_MESH, "liver: no vertices");
    ck_skg_fails(CREATE(-1, 0, 12, 0, 1), SKG_ERR_ARGUMENT, "-1 vertices");
    ck_skg_fails(CREATE(8, 2, 12, 0, 1), SKG_ERR_ARGUMENT, "position stride 2");
    ck_skg_fails(CREATE(8, 0, 12, -3, 1), SKG_ERR_ARGUMENT, "triangle stride -3");
    ck_skg_fails(CREATE(8, 0, 12, 0, 0), SKG_ERR_ARGUMENT, "unit 0 mm");
    ck_skg_fails(CREATE(8, 0, 12, 0, -1), SKG_ERR_ARGUMENT, "unit -1 mm");
    ck_skg_fails(CREATE(8, 0, 12, 0, (double)NAN), SKG_ERR_ARGUMENT, "unit nan mm");
    ck_skg_fails(CREATE(8, 0, 12, 0, (double)INFINITY), SKG_ERR_ARGUMENT, "unit inf mm");
    ck_skg_fails(CREATE(INT64_C(1) << 31, 0, 12, 0, 1), SKG_ERR_MESH, "at most 715827882");
    ck_skg_fails(CREATE(8, 0, INT64_MAX, 0, 1), SKG_ERR_MESH, "at most 715827882");
    ck_skg_fails(CREATE(8, 0, 12, 0, 1e308), SKG_ERR_MESH, "more than single precision");
    ck_skg_fails(skg_mesh_create(NULL, "liver",
                                 &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                    .vertices = 8,
                                                    .positions = NULL,
                                                    .triangles = 12,
                                                    .corners = c,
                                                    .unit_mm = 1},
                                 &mesh),
                 SKG_ERR_ARGUMENT, "positions are NULL");
    ck_skg_fails(skg_mesh_create(NULL, "liver",
                                 &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                    .vertices = 8,
                                                    .positions = p,
                                                    .triangles = 12,
                                                    .corners = NULL,
                                                    .unit_mm = 1},
                                 &mesh),
                 SKG_ERR_ARGUMENT, "triangles are NULL");
    const float q[24] = {0};
    ck_skg_fails(skg_mesh_create(NULL, "liver",
                                 &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                    .vertices = 8,
                                                    .positions = p,
                                                    .floats = q,
                                                    .triangles = 12,
                                                    .corners = c,
                                                    .unit_mm = 1},
                                 &mesh),
                 SKG_ERR_ARGUMENT, "positions and floats are both given");
    ck_skg_fails(skg_mesh_create(NULL, "liver", NULL, &mesh), SKG_ERR_ARGUMENT, "skg_mesh_source");
    ck_skg_fails(skg_mesh_create(NULL, "liver",
                                 &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                    .vertices = 8,
                                                    .positions = p,
                                                    .triangles = 12,
                                                    .corners = c,
                                                    .unit_mm = 1},
                                 NULL),
                 SKG_ERR_ARGUMENT, "skg_mesh_create: the argument mesh is NULL");
    c[3 * 7 + 1] = 8;
    ck_skg_fails(CREATE(8, 0, 12, 0, 1), SKG_ERR_MESH, "liver: triangle 7 names vertex 8, but");
    c[3 * 7 + 1] = -1;
    ck_skg_fails(CREATE(8, 0, 12, 0, 1), SKG_ERR_MESH, "triangle 7 names vertex -1");
    p[3 * 6] = (double)NAN;
    p[3 * 5 + 2] = -(double)INFINITY;
    ck_skg_fails(CREATE(8, 0, 12, 0, 1), SKG_ERR_MESH, "liver: vertex 5 is at (");
#undef CREATE
    ck_assert_ptr_null(mesh);
    ck_skg_fails(skg_mesh_retain(NULL), SKG_ERR_ARGUMENT, "skg_mesh_retain");
    ck_skg_fails(skg_mesh_positions_get(NULL, p, 0), SKG_ERR_ARGUMENT, "mesh is NULL");
    ck_skg_fails(skg_mesh_offsets_moved(NULL), SKG_ERR_ARGUMENT, "mesh is NULL");
    skg_mesh_release(&mesh);
    skg_mesh_release(NULL);
}
END_TEST

START_TEST(health_of_another_size) {
    skg_mesh *mesh;
    skg_mesh_health health;
    ck_skg(skg_mesh_create_cube(1, &mesh));
    skg_mesh_health_init(&health);
    health.size = 3 * sizeof(int32_t); /* an older caller's */
    health.outward = 77;
    ck_skg(skg_mesh_health_get(mesh, &health));
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.outward, 77);
    ck_assert_int_eq(health.size, 3 * (int)sizeof(int32_t));
    skg_mesh_release(&mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, numbering_strides_and_units_are_the_callers);
    tcase_add_test(tests, missing_triangle_leaves_three_open_edges);
    tcase_add_test(tests, inverted_cube_is_turned_with_a_warning);
    tcase_add_test(tests, equal_positions_are_welded_for_the_health);
    tcase_add_test(tests, faults_are_counted);
    tcase_add_test(tests, cubes_that_share_an_edge_are_closed);
    tcase_add_test(tests, health_agrees_with_brute_force);
    tcase_add_test(tests, mirrored_positions_turn_a_closed_mesh);
    tcase_add_test(tests, far_mesh_keeps_its_volume_and_offsets);
    tcase_add_test(tests, moving_in_place);
    tcase_add_test(tests, bad_arrays_are_named);
    tcase_add_test(tests, health_of_another_size);
}

SKG_SUITE_MAIN("mesh", add_tests)
