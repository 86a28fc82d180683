/* Plates that are seen nearly edge-on as strips of up to a few pixels: a step of floats of one corner would move the depth of a
 * face by more than the bar of docs/numerics.md#precision, max(3e-5 L, 2e-6 D) with L the longest path and D the extent along
 * the rays. So their corners keep what rounding has lost. Before they did, 475 pixels of these plates were outside. */
#include "suite.h"
#include "support/random.h"
#include "support/verdict.h"

#include <float.h>
#include <math.h>

enum { SIZE = 64, PLATES = 160 };

/* Turns by angle `a` in the plane of two axes. */
static void turn(solid *s, int from, int to, double a) {
    double m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    m[4 * from + from] = m[4 * to + to] = cos(a);
    m[4 * from + to] = -sin(a);
    m[4 * to + from] = sin(a);
    solid_move(s, m);
}

/* 0.01 to 0.3 mm thick, 300 mm long, 20 to 300 mm deep along the rays, from which it leans so far that it is seen 0.05 to 3
 * pixels wide. */
static solid plate(uint64_t *seed, skg_view *view) {
    const double deep = pow(10, draw(seed, 1.3, 2.5)),
                 wide = view->column_step[0] * pow(10, draw(seed, -1.3, 0.5));
    solid s = solid_box(300, deep, pow(10, draw(seed, -2, -0.5)));
    turn(&s, 1, 2, 1.5707963267948966 - asin(fmin(0.9, wide / deep)));
    turn(&s, 0, 1, draw(seed, 0, 6.28));
    solid_shift(&s, draw(seed, -9, 9), draw(seed, -9, 9), draw(seed, -50, 50));
    return s;
}

/* How many pixels are off by more than the bar, also from the lengths of shifted rays. *met: pixels with a length. */
static int64_t count_outside(const solid *s, const skg_view *view, const double *got, int64_t *met) {
    double low = HUGE_VAL, high = -HUGE_VAL, longest = 0;
    double *exact = calloc(SIZE * SIZE, sizeof *exact);
    int64_t outside = 0;
    caster *c = caster_create(s, NULL);
    for (int64_t v = 0; v < s->vertices; v++) {
        low = fmin(low, s->positions[3 * v + 2]);
        high = fmax(high, s->positions[3 * v + 2]);
    }
    for (int64_t p = 0; p < SIZE * SIZE; p++) {
        exact[p] = (double)caster_length(c, view, p % SIZE, p / SIZE);
        longest = fmax(longest, exact[p]);
    }
    const double bar = fmax(3e-5 * longest, 2e-6 * (high - low));
    for (int64_t p = 0; p < SIZE * SIZE; p++) {
        double least, most;
        *met += exact[p] != 0;
        if (fabs(got[p] - exact[p]) <= bar) continue;
        caster_range(c, view, p % SIZE, p / SIZE, 4 * (double)FLT_EPSILON * SIZE / 2, &least, &most);
        outside += got[p] < least - bar || got[p] > most + bar;
    }
    caster_free(c);
    free(exact);
    return outside;
}

START_TEST(plates_edge_on) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    uint64_t seed = 7;
    int64_t outside = 0, met = 0;
    for (int n = 0; n < PLATES; n++) {
        skg_view view = run_view(SIZE, 6);
        if (n % 2) view.projection = SKG_PROJECTION_PARALLEL;
        solid s = plate(&seed, &view);
        double *got = run_solid(&s, NULL, &view, (run_choice){.strategy = strategies[n % 3]});
        outside += count_outside(&s, &view, got, &met);
        free(got);
        solid_free(&s);
    }
    ck_assert_int_gt(met, 20 * PLATES);
    ck_assert_msg(outside == 0, "%lld of %lld pixels with a length are outside the bar", (long long)outside,
                  (long long)met);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, plates_edge_on);
}

SKG_SUITE_MAIN("plates", add_tests)
