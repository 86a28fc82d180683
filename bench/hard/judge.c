#include "hard/judge.h"

#include "support/caster.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static const double bar = 3e-5;

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

/* Where a vertex falls on the detector of hard_view, in pixels. */
static void place_of(const skg_view *view, const double *p, double at[2]) {
    const double depth = (p[2] - view->source[2]) / (view->centre[2] - view->source[2]);
    const double scale = view->projection == SKG_PROJECTION_POINT ? depth : 1;
    at[0] = p[0] / (scale * view->column_step[0]) + 0.5 * (double)(view->columns - 1);
    at[1] = p[1] / (scale * view->row_step[1]) + 0.5 * (double)(view->rows - 1);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void widen(caster *c, const skg_view *view, double column, double row, double *low, double *high) {
    const double length = (double)caster_length(c, view, (long double)column, (long double)row);
    *low = fmin(*low, length);
    *high = fmax(*high, length);
}

/* Widens the interval on one row: the length takes its extremes where edges cross the row, and a blade may be thinner than
 * any grid, so that the places between neighbouring crossings within the shift are tried. */
static void look_along(caster *c, const solid *s, const skg_view *view, double column, double row,
                       double shift, double *low, double *high) {
    enum { MOST = 256 };
    double crossings[MOST + 2];
    int count = 0;
    crossings[count++] = column - shift;
    crossings[count++] = column + shift;
    for (int64_t n = 0; n < 3 * s->triangles && count < MOST + 2; n++) {
        double a[2], b[2];
        place_of(view, s->positions + 3 * (int64_t)s->corners[n], a);
        place_of(view, s->positions + 3 * (int64_t)s->corners[n % 3 == 2 ? n - 2 : n + 1], b);
        if ((a[1] < row) == (b[1] < row)) continue;
        const double x = a[0] + (row - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        if (fabs(x - column) < shift) crossings[count++] = x;
    }
    qsort(crossings, (size_t)count, sizeof *crossings, ascending);
    for (int n = 0; n + 1 < count; n++) {
        widen(c, view, crossings[n], row, low, high);
        widen(c, view, 0.5 * (crossings[n] + crossings[n + 1]), row, low, high);
    }
}

static void look_closer(caster *c, const solid *s, const skg_view *view, int64_t column, int64_t row,
                        double shift, double *low, double *high) {
    enum { STEPS = 8 };
    for (int n = -STEPS; n <= STEPS; n++)
        look_along(c, s, view, (double)column, (double)row + n * shift / STEPS, shift, low, high);
}

static double distance(double got, double low, double high) {
    return fmax(0, fmax(low - got, got - high));
}

void hard_judge(const solid *s, const skg_view *view, const float *single, const double *twice,
                hard_verdict *v) {
    const int64_t pixels = view->columns * view->rows;
    const double shift = 4 * (double)FLT_EPSILON * radius_of(view, twice);
    double longest = 0;
    caster *c = NULL;
    for (int64_t n = 0; n < pixels; n++) longest = fmax(longest, twice[n]);
    v->pixels += pixels;
    for (int64_t n = 0; n < pixels; n++) {
        const double got = (double)single[n];
        v->met += twice[n] != 0 || single[n] != 0;
        v->lowest = fmin(v->lowest, got / longest);
        /* 1 % is a thousand times what the error in double precision adds. */
        if (fabs(got - twice[n]) <= 0.99 * bar * longest) continue;
        const int64_t column = n % view->columns, row = n / view->columns;
        double low, high;
        if (!c) c = caster_create(s, NULL);
        caster_range(c, view, column, row, shift, &low, &high);
        if (distance(got, low, high) > bar * longest)
            look_closer(c, s, view, column, row, shift, &low, &high);
        const double off = distance(got, low, high) / longest;
        v->judged++;
        v->worst = fmax(v->worst, off);
        if (off > bar + (high - low) / longest || isnan(got) || isnan(low))
            v->out++;
        else
            v->thin += off > bar;
    }
    caster_free(c);
}
