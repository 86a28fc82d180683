/* Judges the lengths in single precision of every pixel of a picture. */
#include "hard/judge.h"

#include "hard/interval.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* The body's extent along the rays. */
static double extent_of(const solid *s) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int64_t v = 0; v < s->vertices; v++) {
        low = fmin(low, s->positions[3 * v + 2]);
        high = fmax(high, s->positions[3 * v + 2]);
    }
    return high - low;
}

/* Half of the larger side of the pixels that are met: the largest coordinate relative to the part, but for one pixel. */
static double radius_of(const skg_view *view, const double *lengths) {
    int64_t low[2] = {view->columns, view->rows}, high[2] = {0, 0};
    for (int64_t n = 0; n < view->columns * view->rows; n++) {
        const int64_t at[2] = {n % view->columns, n / view->columns};
        for (int k = 0; k < 2 && lengths[n] != 0; k++) {
            if (at[k] < low[k]) low[k] = at[k];
            if (at[k] > high[k]) high[k] = at[k];
        }
    }
    return 1 + 0.5 * (double)(high[0] - low[0] > high[1] - low[1] ? high[0] - low[0] : high[1] - low[1]);
}

typedef enum { GOOD, THIN, FOLDED, OUT } opinion;

/* docs/numerics.md#precision has the bars. Two steep faces that are nearer to each other than the shift may have any
 * length of the interval, give or take its width: a plate thinner than the last bits, seen edge-on. If more faces lie so
 * near, which are those of a plate folded upon itself, roundings of single corners decide which of them come first, and
 * any of their depths may be counted. */
static opinion judge(const hard_interval *exact, double got, double bar) {
    const double off = hard_distance(exact, got) - bar;
    if (isnan(got) || isnan(exact->low)) return OUT;
    if (off <= 0) return GOOD;
    if (exact->steep_faces >= 2 && off <= exact->high - exact->low) return THIN;
    return exact->steep_faces > 2 && off <= exact->farthest - exact->nearest ? FOLDED : OUT;
}

/* A pixel that the two precisions disagree about. */
static void judge_pixel(const hard_sight *sight, int64_t column, int64_t row, double shift, double longest,
                        double bar, double got, const char *name, hard_verdict *v) {
    static const double works[] = {1e5, 3e6, 1e8}; /* more and more thoroughly, until it is good */
    hard_interval exact;
    opinion found = OUT;
    for (int k = 0; k < 3 && found != GOOD && (k < 2 || found != THIN); k++) {
        exact = hard_interval_of(sight, column, row, shift, longest, got, 0.1 * bar, works[k]);
        found = judge(&exact, got, bar);
    }
    v->judged++;
    v->worst = fmax(v->worst, hard_distance(&exact, got) / longest);
    v->thin += found == THIN;
    v->folded += found == FOLDED;
    v->out += found == OUT;
    if (found == OUT || found == FOLDED)
        printf("%s: row %" PRId64 ", column %" PRId64 ": %.9g mm is outside %.9g to %.9g mm, L = %.6g mm%s\n",
               name, row, column, got, exact.low, exact.high, longest, found == OUT ? "" : " (folded)");
}

void hard_judge(const solid *s, const skg_view *view, double share, const float *single, const double *twice,
                const char *name, hard_verdict *v) {
    const int64_t pixels = view->columns * view->rows;
    const double shift = 4 * (double)FLT_EPSILON * radius_of(view, twice);
    double longest = 0;
    hard_sight sight = {0};
    for (int64_t n = 0; n < pixels; n++) longest = fmax(longest, twice[n]);
    /* 3e-5 of the longest path, but at least a share of the extent: up to 1e-6 of it, a face counts as not steep, and a ray
     * through a plate meets two. */
    const double extent = extent_of(s), bar = fmax(3e-5 * longest, share * extent);
    v->pixels += pixels;
    for (int64_t n = 0; n < pixels; n++) {
        const double got = (double)single[n];
        v->met += twice[n] != 0 || single[n] != 0;
        v->rough += fabs(got - twice[n]) > 3e-5 * longest + 5e-7 * extent;
        v->lowest = fmin(v->lowest, got / longest);
        /* 1 % is a thousand times what the error in double precision adds. */
        if (fabs(got - twice[n]) <= 0.99 * bar) continue;
        if (!sight.places) sight = hard_see(s, view);
        judge_pixel(&sight, n % view->columns, n / view->columns, shift, longest, bar, got, name, v);
    }
    hard_sight_free(&sight);
}
