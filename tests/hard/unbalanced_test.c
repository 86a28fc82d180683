/* No pixel's signed hits fail to cancel on any closed mesh, however hard, and the lengths are right. */
#include "hard/balance.h"
#include "hard/scenes.h"
#include "suite.h"
#include "support/random.h"
#include "support/verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int32_t precisions(void) {
    return run_has_double() ? 2 : 1;
}

static void check_balance(int which) {
    hard_scene h = hard_make(which);
    for (int32_t precision = 0; precision < precisions(); precision++) {
        const int64_t bad = count_bad(&h.body, h.pose, &h.view, (double)(h.view.columns / 2) + 0.5, 0.05,
                                      (run_choice){.precision = precision});
        ck_assert_msg(bad == 0, "%s: %d unbalanced pixels (precision %d)", h.name, (int)bad, (int)precision);
    }
    hard_free(&h);
}

/* Tests take the scenes in a loop of their own: a device is opened once for all. */
START_TEST(no_pixel_is_unbalanced) {
    for (int which = 0; which < HARD_SCENES; which++) check_balance(which);
}
END_TEST

/* The count of the test before counts: a stray triangle of six pixels is found in every pixel that it covers.
 */
START_TEST(an_open_body_is_found) {
    const skg_view view = run_view(40, 1);
    solid box = solid_box(5, 5, 5), open = solid_copy(&box), extra = stray(&view, 20.3, 20.3, 6.1);
    solid_add(&open, &extra);
    caster *c = caster_create(&open, NULL);
    int64_t expected = 0;
    for (int64_t p = 0; p < 40 * 40; p++)
        expected += isnan(caster_length(c, &view, (long double)(p % 40), (long double)(p / 40))) != 0;
    ck_assert_int_gt(expected, 5);
    for (int32_t precision = 0; precision < precisions(); precision++)
        ck_assert_int_eq(count_bad(&box, NULL, &view, 20.3, 6.1, (run_choice){.precision = precision}),
                         expected);
    caster_free(c);
    solid_free(&box);
    solid_free(&open);
    solid_free(&extra);
}
END_TEST

/* Depth on a sliver is extrapolated from a steep gradient, so the root mean square has a bar of its own: twice the
 * 1.6e-6 Lmax that was measured, while the worst keeps the common bar. */
static void check_bars(const verdict *v, const hard_scene *h, int32_t precision) {
    if (!h->sliver || precision == SKG_PRECISION_DOUBLE) {
        verdict_check(v, precision, h->name);
        return;
    }
    ck_assert_msg(verdict_rms(v) <= 3.2e-6 && verdict_worst(v) <= 1e-3,
                  "%s, single: rms %.3g, worst %.3g of Lmax", h->name, verdict_rms(v), verdict_worst(v));
}

/* As many rays as take the caster a tenth of a second, but enough of them. */
static int64_t rays_for(const hard_scene *h) {
    const int64_t rays = 2000000 / (h->body.vertices * (h->wobble > 0 ? 5 : 1));
    return rays < 80 ? 80 : rays < 4225 ? rays : 4225;
}

static void check_lengths(int which) {
    hard_scene h = hard_make(which);
    caster *c = caster_create(&h.body, h.pose);
    const window where = window_of(&h.body, h.pose, &h.view);
    const int64_t pixels = h.view.rows * h.view.columns;
    for (int32_t precision = 0; precision < precisions(); precision++) {
        uint64_t seed = 3;
        double *got = run_solid(&h.body, h.pose, &h.view, (run_choice){.precision = precision});
        verdict v = {0};
        int turned = 0;
        const int64_t rays = rays_for(&h);
        verdict_cast(&v, c, &h.view, got, where, rays, h.wobble, &seed);
        check_bars(&v, &h, precision);
        /* The other pixels: an unbalanced one would be off by its distance to the source, mostly below. */
        double longest = 0;
        for (int64_t p = 0; p < pixels; p++) longest = fmax(longest, got[p]);
        for (int64_t p = 0; p < pixels; p++) {
            const int64_t column = p % h.view.columns, row = p / h.view.columns;
            turned += got[p] < -1e-3 * longest;
            ck_assert_msg(got[p] >= -longest && !isnan(got[p]), "%s: %g mm at (%d, %d)", h.name, got[p],
                          (int)column, (int)row);
            if (column < where.first_column || column > where.last_column || row < where.first_row ||
                row > where.last_row)
                ck_assert_double_eq(got[p], 0);
        }
        ck_assert_msg((double)turned <= h.turned * (double)pixels, "%s: %d pixels below 0", h.name, turned);
        verdict_free(&v);
        free(got);
    }
    caster_free(c);
    hard_free(&h);
}

START_TEST(lengths_are_right) {
    for (int which = 0; which < HARD_SCENES; which++) check_lengths(which);
}
END_TEST

/* A wall of 0.01 mm is as exact as a thick one, however far the source. */
START_TEST(thin_wall) {
    solid wall = solid_box(90, 80, 0.01);
    for (int n = 0; n < 4; n++) {
        skg_view view = run_view(64, 2);
        uint64_t seed = 1;
        view.source[2] = n & 1 ? -1e6 : -1000;
        if (n & 2) solid_shift(&wall, 11, 7, n & 1 ? 0 : 43);
        caster *c = caster_create(&wall, NULL);
        for (int32_t precision = 0; precision < precisions(); precision++) {
            double *got = run_solid(&wall, NULL, &view, (run_choice){.precision = precision});
            verdict v = {0};
            verdict_cast(&v, c, &view, got, (window){0, 63, 0, 63}, 64 * 64, 1e-4, &seed);
            /* The wall is 0.01 mm thick; oblique rays have up to twice that. */
            ck_assert_double_lt(v.longest, 0.02);
            /* Double: the wall's own corners are doubles, 43 mm off by 4e-15: 1e-12 of the wall's thickness;
             * and the source at 1e6 mm costs a part in 1e-16 of that distance. */
            if (precision == SKG_PRECISION_DOUBLE)
                ck_assert_double_le(verdict_worst(&v), 1e-10 / 0.01);
            else
                verdict_check(&v, precision, "thin wall");
            ck_assert_int_eq(count_bad(&wall, NULL, &view, 31.5, 0.05, (run_choice){.precision = precision}),
                             0);
            verdict_free(&v);
            free(got);
        }
        caster_free(c);
    }
    solid_free(&wall);
}
END_TEST

/* A hundred plates, one behind the other or all at one place, as parts or as one mesh. */
START_TEST(a_hundred_plates) {
    enum { PLATES = 100, PIXELS = 32 };
    const skg_view view = run_view(PIXELS, 1);
    for (int together = 0; together < 2; together++) {
        solid plate = solid_box(400, 400, 1), all = solid_plates(PLATES, 400, 400, 1, together ? -1 : 2.9);
        skg_mesh *mesh = run_mesh(&plate);
        skg_scene *scene = NULL;
        ck_skg(skg_scene_create(run_context, &scene));
        for (int n = 0; n < PLATES; n++) {
            char label[16];
            double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
            pose[11] = together ? 0 : 3.9 * n - 193.05;
            snprintf(label, sizeof label, "plate %d", n);
            run_part(scene, label, mesh, 0.5, pose, -1); /* 0.05 per mm: exponent 5 */
        }
        for (int32_t precision = 0; precision < precisions(); precision++) {
            const run_choice choice = {.precision = precision, .quantity = SKG_QUANTITY_ATTENUATION};
            skg_plan *plan = run_plan(scene, &view, choice);
            double *image = run_image(plan, &view), *lengths = run_solid(&all, NULL, &view, choice);
            /* Single: 200 hits, each rounded to a few units of 1 mm's last place at 1200 mm depth: as the
             * bars. */
            const double bar = precision == SKG_PRECISION_DOUBLE ? 1e-11 : 3e-6;
            for (int p = 0; p < PIXELS * PIXELS; p++) {
                const double x = p % PIXELS - 15.5, y = (double)(p / PIXELS) - 15.5;
                const double expected = PLATES * sqrt(1 + (x * x + y * y) / (1200.0 * 1200.0));
                ck_assert_double_eq_tol(lengths[p], expected, bar * expected);
                ck_assert_double_eq_tol(image[p], 0.05 * expected, bar * 0.05 * expected);
            }
            free(image);
            free(lengths);
            skg_plan_release(&plan);
        }
        skg_scene_release(&scene);
        skg_mesh_release(&mesh);
        solid_free(&plate);
        solid_free(&all);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, no_pixel_is_unbalanced);
    tcase_add_test(tests, an_open_body_is_found);
    tcase_add_test(tests, lengths_are_right);
    tcase_add_test(tests, thin_wall);
    tcase_add_test(tests, a_hundred_plates);
}

SKG_SUITE_MAIN("unbalanced", add_tests)
