/* Faces nearly along the rays, and corners on them: depth has to belong to the same rounded ray as coverage.
 *
 * The bars (docs/numerics.md#precision), with L the longest path and the shift 4 units in the last place of the
 * coordinate relative to the part: where the exact length changes by at most 1e-6 L under such shifts of the ray, rms
 * 3e-7 L, 99.9 % within 3e-6 L, all within 3e-5 L, none below -1e-6 L; elsewhere within 3e-5 L of the interval that the
 * exact length takes under the shifts. */
#include "suite.h"
#include "support/random.h"
#include "support/verdict.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Errors of one picture, in units of L. */
typedef struct {
    /* pixels anywhere where the length hardly changes under the shifts; beyond 3e-6 L */
    int64_t sound, beyond;
    int64_t sensitive; /* pixels where it changes */
    double squares;    /* of the errors of the sound ones */
    double worst, lowest, outside;
} figures;

/* A pixel to be judged, and how much it differs between the precisions. */
typedef struct {
    int64_t pixel;
    double difference;
} candidate;

static int by_difference(const void *a, const void *b) {
    const candidate *left = a, *right = b;
    return (left->difference < right->difference) - (left->difference > right->difference);
}

/* Pixels worth judging: half of them those where single and double precision differ most, half anywhere. */
static candidate *choose(const solid *s, const skg_view *view, const double *got, int64_t pixels) {
    const int64_t all = view->rows * view->columns;
    candidate *list = calloc((size_t)all, sizeof *list);
    double *twin =
        run_has_double() ? run_solid(s, NULL, view, (run_choice){.precision = SKG_PRECISION_DOUBLE}) : NULL;
    uint64_t seed = 1;
    for (int64_t p = 0; p < all; p++) list[p] = (candidate){p, twin ? fabs(got[p] - twin[p]) : 0};
    qsort(list, (size_t)all, sizeof *list, by_difference);
    for (int64_t n = pixels / 2; n < pixels; n++) list[n] = list[n + draw_below(&seed, all - n)];
    free(twin);
    return list;
}

static figures judge(const solid *s, const skg_view *view, const double *got, double radius, int64_t pixels) {
    const double shift = 4 * (double)FLT_EPSILON * radius;
    caster *c = caster_create(s, NULL);
    candidate *list = choose(s, view, got, pixels);
    double *values = calloc((size_t)(4 * pixels), sizeof *values), longest = 0;
    for (int64_t n = 0; n < pixels; n++) {
        const int64_t column = list[n].pixel % view->columns, row = list[n].pixel / view->columns;
        double *v = values + 4 * n;
        v[0] = got[list[n].pixel];
        v[1] = (double)caster_length(c, view, column, row);
        caster_range(c, view, column, row, shift, &v[2], &v[3]);
        longest = fmax(longest, v[1]);
    }
    figures f = {0};
    for (int64_t n = 0; n < pixels; n++) {
        const double *v = values + 4 * n;
        const double error = (v[0] - v[1]) / longest;
        const double off = fmax(0, fmax(v[2] - v[0], v[0] - v[3])) / longest;
        if (v[3] - v[2] <= 1e-6 * longest) {
            if (n >= pixels / 2) { /* the others were chosen for their error */
                f.sound++;
                f.squares += error * error;
                f.beyond += fabs(error) > 3e-6; /* the bar of docs/numerics.md#precision for 99.9 % */
            }
            f.worst = fmax(f.worst, fabs(error));
            f.lowest = fmin(f.lowest, v[0] / longest);
        } else {
            f.sensitive++;
            f.outside = fmax(f.outside, off);
        }
    }
    caster_free(c);
    free(list);
    free(values);
    return f;
}

static void check(const char *what, const solid *s, const skg_view *view, double radius, int64_t pixels) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    uint64_t hashes[3];
    for (int k = 0; k < 3; k++) {
        double *got = run_solid(s, NULL, view, (run_choice){.strategy = strategies[k]});
        hashes[k] = run_hash(got, view->rows * view->columns * (int64_t)sizeof *got);
        if (k == 0) {
            const figures f = judge(s, view, got, radius, pixels);
            const double rms = sqrt(f.squares / (double)(f.sound ? f.sound : 1));
            ck_assert_msg(
                rms <= 3e-7 && (double)f.beyond <= 1e-3 * (double)f.sound && f.worst <= 3e-5 &&
                    f.lowest >= -1e-6 && f.outside <= 3e-5,
                "%s: rms %.3g, %lld of %lld beyond 3e-6, worst %.3g, lowest %.3g, %.3g outside in %lld of L",
                what, rms, (long long)f.beyond, (long long)f.sound, f.worst, f.lowest, f.outside,
                (long long)f.sensitive);
        }
        free(got);
    }
    ck_assert_msg(hashes[0] == hashes[1] && hashes[0] == hashes[2], "%s: strategies differ", what);
}

/* 256 x 256 pixels of 0.4 mm under a parallel beam along z. */
static skg_view parallel_view(void) {
    skg_view view = run_view(256, 0.4);
    view.projection = SKG_PROJECTION_PARALLEL;
    return view;
}

/* Moves every vertex onto the nearest ray, give or take `ulps` units in the last place of a float. */
static void pull_onto_rays(solid *s, const skg_view *view, int ulps, uint64_t seed) {
    for (int64_t n = 0; n < s->vertices; n++)
        for (int k = 0; k < 2; k++) {
            const double step = k == 0 ? view->column_step[0] : view->row_step[1];
            const double middle = 0.5 * (double)((k == 0 ? view->columns : view->rows) - 1);
            float x = (float)((round(s->positions[3 * n + k] / step + middle) - middle) * step);
            for (int64_t u = draw_below(&seed, 2 * ulps + 1) - ulps; u != 0; u += u < 0 ? 1 : -1)
                x = nextafterf(x, u < 0 ? -INFINITY : INFINITY);
            s->positions[3 * n + k] = (double)x;
        }
}

START_TEST(corners_on_rays) {
    const skg_view view = parallel_view();
    solid solids[] = {solid_sphere(40, 80, 33), solid_blob(40, 80, 33, 5), solid_torus(28, 12, 90, 30)};
    for (int k = 0; k < 3; k++) {
        pull_onto_rays(&solids[k], &view, 2, (uint64_t)k + 1);
        check(k == 0 ? "sphere" : k == 1 ? "blob" : "torus", &solids[k], &view, 100, 2500);
        solid_free(&solids[k]);
    }
}
END_TEST

/* A slab whose faces lean from the ray by a small angle, under a parallel beam and from a point. */
START_TEST(slabs_nearly_edge_on) {
    for (int point = 0; point < 2; point++)
        for (int k = 0; k < 5; k++) {
            skg_view view = parallel_view();
            if (point) view.projection = SKG_PROJECTION_POINT;
            const double angle = pow(10, -k) * 0.3, c = cos(angle), sine = sin(angle), turn = 0.4;
            solid s = solid_box(60, 6, 50);
            const double lean[12] = {1, 0, 0, 0, 0, c, -sine, 0, 0, sine, c, 0};
            const double round[12] = {cos(turn), -sin(turn), 0, 3.3, sin(turn), cos(turn),
                                      0,         2.7,        0, 0,   1,         0};
            solid_move(&s, lean);
            solid_move(&s, round);
            char what[64];
            snprintf(what, sizeof what, "%s, slab at %.3g rad", point ? "point" : "parallel", angle);
            check(what, &s, &view, 90, 3000);
            solid_free(&s);
        }
}
END_TEST

/* Slivers: a sphere flattened along a direction across the ray and along it. */
START_TEST(slivers) {
    const skg_view view = run_view(256, 0.4);
    for (int k = 0; k < 2; k++) {
        solid s = solid_sphere(35, 60, 30);
        const double flat[12] = {k == 0 ? 0.02 : 1, 0, 0.3, 0, 0, 1, 0, 0, 0, 0, k == 0 ? 1 : 0.02, 0};
        solid_move(&s, flat);
        check(k == 0 ? "flat across" : "flat along", &s, &view, 90, 2000);
        solid_free(&s);
    }
}
END_TEST

/* Bodies of a few pixels whose corners lie on the rays: blades that are thinner than the last bit of a coordinate lean over
 * many of them. Depth has to be that of the ray by which coverage was decided, to a small part of that bit; these two
 * were 0.0049 L and 0.14 L outside. */
START_TEST(octahedra_on_rays) {
    static const uint64_t seeds[] = {3, 13};
    for (int k = 0; k < 2; k++) {
        const skg_view view = run_view(512, 0.2);
        solid s = solid_octahedra(2000, &view, k == 0 ? 2 : 0, 1, seeds[k]);
        solid_round(&s);
        double *got = run_solid(&s, NULL, &view, (run_choice){0});
        const figures f = judge(&s, &view, got, 256, 120);
        /* Five rays stand for all within the shift; blades between them have lengths that they do not meet. */
        ck_assert_msg(f.outside <= 1e-3, "seed %d: %.3g of L outside", (int)seeds[k], f.outside);
        free(got);
        solid_free(&s);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, corners_on_rays);
    tcase_add_test(tests, slabs_nearly_edge_on);
    tcase_add_test(tests, slivers);
    tcase_add_test(tests, octahedra_on_rays);
}

SKG_SUITE_MAIN("steep", add_tests)
