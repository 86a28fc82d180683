/* The judge is judged: the ray caster against closed forms, and its signed hits always cancel. */
#include "suite.h"
#include "support/angles.h"
#include "support/caster.h"
#include "support/random.h"

#include <float.h>
#include <math.h>

static const double epsilon = 64 * (double)LDBL_EPSILON; /* a few roundings of 1 in long double */

/* n x n pixels of `pitch` around z at z = 200, source at z = -1000. */
static skg_view view_of(int64_t n, double pitch) {
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = n;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = pitch;
    return view;
}

START_TEST(makers_are_outward_and_of_the_right_volume) {
    const double box[3] = {50, 50, 50};
    const skg_view view = view_of(64, 1);
    solid all[] = {solid_box(2, 3, 4),
                   solid_plates(5, 10, 10, 0.5, 1),
                   solid_sphere(10, 400, 200),
                   solid_torus(20, 5, 400, 200),
                   solid_shell(10, 9, 400, 200),
                   solid_blob(10, 60, 30, 1),
                   solid_tetrahedra(10, 3, box, 2),
                   solid_octahedra(10, &view, 3, 2, 3)};
    const double volumes[] = {24, 250, 4 * pi * 1000 / 3, 2 * pi * pi * 20 * 25, 4 * pi * 271 / 3};
    for (size_t n = 0; n < sizeof all / sizeof *all; n++) {
        const double volume = solid_volume(&all[n]);
        ck_assert_double_gt(volume, 0);
        /* Chords of 0.9 degrees lie within (pi / 200)^2 of the surface. */
        if (n < sizeof volumes / sizeof *volumes) ck_assert_double_eq_tol(volume / volumes[n], 1, 1e-3);
        skg_mesh *mesh = NULL;
        skg_mesh_health health;
        skg_mesh_health_init(&health);
        ck_skg(skg_mesh_create(NULL, "solid",
                               &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                  .vertices = all[n].vertices,
                                                  .positions = all[n].positions,
                                                  .triangles = all[n].triangles,
                                                  .corners = all[n].corners,
                                                  .unit_mm = 1},
                               &mesh));
        ck_skg(skg_mesh_health_get(mesh, &health));
        ck_assert_int_eq(health.closed, 1);
        ck_assert_int_eq(health.flipped, 0);
        /* Sums of 1e5 and more triangles, in two orders. */
        ck_assert_double_eq_tol(health.volume, volume, 1e5 * DBL_EPSILON * volume);
        skg_mesh_release(&mesh);
        solid_free(&all[n]);
    }
}
END_TEST

START_TEST(cube_by_hand) {
    const skg_view view = view_of(33, 3.7); /* the middle ray runs through the diagonals of two faces */
    solid cube = solid_box(100, 100, 100);
    caster *c = caster_create(&cube, NULL);
    for (int64_t p = 0; p < 33 * 33; p++) {
        const long double x = ((long double)(p % 33) - 16) * (long double)3.7,
                          y = ((long double)(p / 33) - 16) * (long double)3.7;
        const long double widest = fmaxl(fabsl(x), fabsl(y));
        /* Enters the front face at z = -50 if within it; leaves by the back face at z = 50 or the nearest
         * side. */
        const long double in = 950.0L / 1200, out = fminl(1050.0L / 1200, widest > 0 ? 50 / widest : 1);
        const long double expected = fmaxl(0, out - in) * sqrtl(x * x + y * y + 1200.0L * 1200);
        ck_assert_double_eq_tol((double)caster_length(c, &view, (long double)(p % 33), (long double)(p / 33)),
                                (double)expected, 1200 * epsilon + 100 * DBL_EPSILON);
    }
    caster_free(c);
    solid_free(&cube);
}
END_TEST

START_TEST(all_projections_and_the_pose) {
    solid box = solid_box(10, 20, 30);
    const double mirror[16] = {0, 0, -1, 0,  0, 1, 0, 0,
                               1, 0, 0,  40, 0, 0, 0, 1}; /* z across, x along; mirrored */
    caster *c = caster_create(&box, mirror);
    skg_view view = view_of(9, 1);
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_assert_double_eq_tol((double)caster_length(c, &view, 4.3L, 4.2L), 10, 1200 * epsilon);
    view.source[2] = 38; /* within: from there to the far face at z = 45 */
    ck_assert_double_eq_tol((double)caster_length(c, &view, 4.3L, 4.2L), 7, 1200 * epsilon);
    view.centre[2] = 43;
    ck_assert_double_eq_tol((double)caster_length(c, &view, 4.3L, 4.2L), 5, 1200 * epsilon);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.source[2] = 1;
    ck_assert_double_eq_tol((double)caster_length(c, &view, 4.3L, 4.2L), 8, 1200 * epsilon);
    view.projection = SKG_PROJECTION_POINT;
    view.source[2] = 39;
    ck_assert_double_eq_tol((double)caster_length(c, &view, 4, 4), 4, 1200 * epsilon);
    caster_free(c);
    solid_free(&box);
}
END_TEST

START_TEST(signed_hits_always_cancel) {
    skg_view view = view_of(200, 1);
    for (int projection = SKG_PROJECTION_POINT; projection <= SKG_PROJECTION_PARALLEL; projection++) {
        view.projection = projection;
        solid s = solid_octahedra(500, &view, projection == SKG_PROJECTION_POINT ? 3 : 0, 1, 7),
              cube = solid_box(64, 64, 64);
        solid_add(&s, &cube);
        caster *c = caster_create(&s, NULL);
        for (int64_t p = 0; p < 200 * 200; p += 7) {
            const long double length =
                caster_length(c, &view, (long double)(p % 200), (long double)(p / 200));
            ck_assert(!isnan(length));
            ck_assert_double_ge((double)length, -1e-12);
        }
        caster_free(c);
        solid_free(&s);
        solid_free(&cube);
    }
}
END_TEST

START_TEST(an_open_solid_is_reported) {
    const skg_view view = view_of(33, 1);
    solid cube = solid_box(10, 10, 10);
    cube.triangles = 11;
    caster *c = caster_create(&cube, NULL);
    int open = 0;
    for (int n = 0; n < 33 * 33; n++) open += isnan(caster_length(c, &view, n % 33, n / 33));
    ck_assert_int_gt(open, 0);
    caster_free(c);
    solid_free(&cube);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, makers_are_outward_and_of_the_right_volume);
    tcase_add_test(tests, cube_by_hand);
    tcase_add_test(tests, all_projections_and_the_pose);
    tcase_add_test(tests, signed_hits_always_cancel);
    tcase_add_test(tests, an_open_solid_is_reported);
}

SKG_SUITE_MAIN("caster", add_tests)
