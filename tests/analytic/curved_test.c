/* Curved detectors: path lengths against a ray caster in long double, which sees each column as a flat detector of one column where
 * the column stands on its cylinder; the same bits by every strategy; closed meshes without a seam. */
#include "curved_views.h"
#include "suite.h"
#include "support/random.h"
#include "support/verdict.h"

#include <string.h>

/* 160 pixels against the caster. */
static void judge(const char *what, const solid *s, const double *pose, const skg_view *view,
                  const double *got, int32_t precision) {
    enum { COUNT = 160 };
    const double shift = precision == SKG_PRECISION_SINGLE ? 4 * (double)COLUMNS * 0x1p-23 : 0;
    double values[COUNT], low[COUNT], high[COUNT], least, most, longest = 0;
    uint64_t seed = 7;
    verdict v = {0};
    caster *c = caster_create(s, pose);
    for (int n = 0; n < COUNT; n++) {
        const int64_t column = draw_below(&seed, COLUMNS), row = draw_below(&seed, ROWS);
        const skg_view one = column_of(view, column);
        values[n] = got[row * COLUMNS + column];
        caster_range(c, &one, 0, row, 0, &low[n], &high[n]);
        longest = fmax(longest, high[n]);
        /* Truth in single is an interval where the length changes much under roundings of the ray (support/verdict.h). */
        caster_range(c, &one, 0, row, shift, &least, &most);
        if (shift > 0 && most - least > 1e-6 * fmax(longest, 1)) low[n] = least, high[n] = most;
    }
    verdict_add(&v, COUNT, values, low, high);
    verdict_check(&v, precision, what);
    verdict_free(&v);
    caster_free(c);
}

static const run_choice choices[] = {{.strategy = SKG_STRATEGY_COPIES},
                                     {.strategy = SKG_STRATEGY_TILES},
                                     {.strategy = SKG_STRATEGY_TILES, .tile = 7},
                                     {.strategy = SKG_STRATEGY_ATOMICS}};
enum { CHOICES = sizeof choices / sizeof *choices };

static void check_solid(const char *name, const solid *s, const double *pose) {
    for (int g = 0; g < 2 * GEOMETRIES; g++) {
        const skg_view view = view_of(&geometries[g / 2], g % 2);
        char what[128];
        snprintf(what, sizeof what, "%s, %s", name, geometries[g / 2].name);
        ck_skg(skg_view_check(&view));
        for (int32_t precision = SKG_PRECISION_SINGLE;
             precision <= (run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE); precision++) {
            double *first = NULL;
            for (int k = 0; k < CHOICES; k++) {
                run_choice choice = choices[k];
                choice.precision = precision;
                double *got = run_solid(s, pose, &view, choice);
                if (!first) {
                    judge(what, s, pose, &view, got, precision);
                    first = got;
                    continue;
                }
                ck_assert_msg(memcmp(first, got, PIXELS * sizeof *got) == 0, "%s: strategy %d has other bits",
                              what, k);
                free(got);
            }
            free(first);
        }
    }
}

static void pose_of(double angle, double x, double y, double z, double pose[16]) {
    const double c = cos(angle), s = sin(angle);
    const double turned[16] = {c, -s, 0, x, s * c, c * c, -s, y, s * s, c * s, c, z, 0, 0, 0, 1};
    memcpy(pose, turned, sizeof turned);
}

START_TEST(large_triangles) {
    double pose[16];
    solid box = solid_box(90, 70, 60);
    pose_of(0.7, 5, -8, 20, pose);
    check_solid("box", &box, pose);
    solid_free(&box);
}
END_TEST

START_TEST(small_triangles) {
    double pose[16];
    solid blob = solid_blob(70, 44, 30, 3);
    pose_of(-0.4, 20, 5, 0, pose);
    check_solid("blob", &blob, pose);
    solid_free(&blob);
}
END_TEST

START_TEST(soup) {
    const double box[3] = {90, 70, 60};
    solid tetrahedra = solid_tetrahedra(300, 12, box, 5);
    check_solid("tetrahedra", &tetrahedra, NULL);
    solid_free(&tetrahedra);
}
END_TEST

/* A seam would show as a whole depth: in every pixel, also where nothing is, lengths are between 0 and the diameter. */
START_TEST(no_seams) {
    uint64_t seed = 11;
    solid ball = solid_sphere(40, 150, 90);
    for (int n = 0; n < 24; n++) {
        double pose[16];
        pose_of(6.2 * draw(&seed, 0, 1), 120 * draw(&seed, 0, 1) - 60, 90 * draw(&seed, 0, 1) - 45,
                60 * draw(&seed, 0, 1), pose);
        const skg_view view = view_of(&geometries[n % GEOMETRIES], n % 2);
        double *got = run_solid(&ball, pose, &view, choices[n % CHOICES]);
        int hit = 0;
        for (int p = 0; p < PIXELS; p++) {
            ck_assert_msg(got[p] > -3e-5 * 80 && got[p] < 80 * (1 + 3e-5), "%s: %.9g mm at pixel %d",
                          geometries[n % GEOMETRIES].name, got[p], p);
            hit += got[p] > 1;
        }
        ck_assert_int_gt(hit, 30);
        free(got);
    }
    solid_free(&ball);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, large_triangles);
    tcase_add_test(tests, small_triangles);
    tcase_add_test(tests, soup);
    tcase_add_test(tests, no_seams);
}

SKG_SUITE_MAIN("curved", add_tests)
