/* Lengths held against the truth, by the bars of docs/numerics.md#precision: single: rms <= 3e-7 Lmax, 99.9 % within 3e-6 Lmax, none beyond 3e-5 Lmax; double: none beyond 1e-11 Lmax. */
#include "support/verdict.h"

#include "suite.h"
#include "support/random.h"

#include <float.h>
#include <math.h>

void verdict_free(verdict *v) {
    free(v->errors);
    *v = (verdict){0};
}

void verdict_add(verdict *v, int64_t count, const double *got, const double *low, const double *high) {
    if (!high) high = low;
    if (v->count + count > v->capacity) {
        v->capacity = 2 * (v->count + count);
        v->errors = realloc(v->errors, (size_t)v->capacity * sizeof *v->errors);
    }
    double longest = 0;
    for (int64_t n = 0; n < count; n++) {
        ck_assert_msg(!isnan(low[n]), "the truth is open");
        longest = fmax(longest, high[n]);
    }
    v->longest = longest;
    for (int64_t n = 0; n < count; n++) {
        const double off = got[n] < low[n] ? low[n] - got[n] : got[n] > high[n] ? got[n] - high[n] : 0;
        /* Where nothing is hit, every error is too large. */
        v->errors[v->count++] = isnan(got[n]) ? HUGE_VAL
                                : off == 0    ? 0
                                : longest > 0 ? off / longest
                                              : HUGE_VAL;
    }
}

void verdict_cast(verdict *v, caster *c, const skg_view *view, const double *got, window where, int64_t count,
                  double wobble, uint64_t *seed) {
    const int64_t wide = where.last_column - where.first_column + 1,
                  tall = where.last_row - where.first_row + 1;
    ck_assert(wide > 0 && tall > 0);
    const int all = wide * tall <= count;
    if (all) count = wide * tall;
    double *values = calloc((size_t)(5 * count), sizeof *values), *low = values + count, *high = low + count;
    double *least = high + count, *most = least + count, longest = 0;
    /* Coordinates relative to the part are at most as large as its window. */
    const double shift = 4 * (double)FLT_EPSILON * (double)(wide > tall ? wide : tall);
    for (int64_t n = 0; n < count; n++) {
        const int64_t k = all ? n : draw_below(seed, wide * tall);
        const int64_t column = where.first_column + k % wide, row = where.first_row + k / wide;
        values[n] = got[row * view->columns + column];
        caster_range(c, view, column, row, wobble, &low[n], &high[n]);
        longest = fmax(longest, high[n]);
        if (v->single) caster_range(c, view, column, row, fmax(wobble, shift), &least[n], &most[n]);
    }
    for (int64_t n = 0; n < count; n++)
        if (v->single && most[n] - least[n] > 1e-6 * longest) low[n] = least[n], high[n] = most[n];
    verdict_add(v, count, values, low, high);
    free(values);
}

/* Where the ray through a point meets the detector, in pixels: solves way * t + column * Du + row * Dv =
 * centre - point by Cramer's rule. 0 where the point is not in front of the source. */
static int shadow(const skg_view *view, const double *point, double at[2]) {
    double way[3], to[3];
    for (int k = 0; k < 3; k++) {
        way[k] = view->projection == SKG_PROJECTION_POINT      ? point[k] - view->source[k]
                 : view->projection == SKG_PROJECTION_PARALLEL ? view->centre[k] - view->source[k]
                                                               : view->source[k];
        to[k] = point[k] - view->centre[k];
    }
    const double *u = view->column_step, *w = view->row_step;
    const double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const double ahead = n[0] * way[0] + n[1] * way[1] + n[2] * way[2];
    const double t = -(n[0] * to[0] + n[1] * to[1] + n[2] * to[2]) / ahead; /* from the point on */
    if (view->projection == SKG_PROJECTION_POINT && !(t > -0.999)) return 0;
    double hit[3], uu = 0, uw = 0, ww = 0, hu = 0, hw = 0;
    for (int k = 0; k < 3; k++) {
        hit[k] = to[k] + t * way[k];
        uu += u[k] * u[k], uw += u[k] * w[k], ww += w[k] * w[k];
        hu += hit[k] * u[k], hw += hit[k] * w[k];
    }
    const double determinant = uu * ww - uw * uw;
    at[0] = (hu * ww - hw * uw) / determinant + (double)(view->columns - 1) / 2;
    at[1] = (hw * uu - hu * uw) / determinant + (double)(view->rows - 1) / 2;
    return isfinite(at[0]) && isfinite(at[1]);
}

static int64_t clamp(double pixel, int64_t count) {
    return pixel < 0 ? 0 : pixel > (double)(count - 1) ? count - 1 : (int64_t)pixel;
}

window window_of(const solid *s, const double *pose, const skg_view *view) {
    static const double none[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double *m = pose ? pose : none;
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int64_t n = 0; n < s->vertices; n++) {
        const double *p = s->positions + 3 * n;
        double point[3], at[2];
        for (int k = 0; k < 3; k++)
            point[k] = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3];
        if (!shadow(view, point, at)) return (window){0, view->columns - 1, 0, view->rows - 1};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    return (window){clamp(floor(low[0]) - 1, view->columns), clamp(ceil(high[0]) + 1, view->columns),
                    clamp(floor(low[1]) - 1, view->rows), clamp(ceil(high[1]) + 1, view->rows)};
}

double verdict_rms(const verdict *v) {
    double sum = 0;
    for (int64_t n = 0; n < v->count; n++) sum += v->errors[n] * v->errors[n];
    return v->count ? sqrt(sum / (double)v->count) : 0;
}

double verdict_worst(const verdict *v) {
    double worst = 0;
    for (int64_t n = 0; n < v->count; n++) worst = fmax(worst, v->errors[n]);
    return worst;
}

double verdict_beyond(const verdict *v, double error) {
    int64_t beyond = 0;
    for (int64_t n = 0; n < v->count; n++) beyond += v->errors[n] > error;
    return (double)beyond / (double)v->count;
}

void verdict_check(const verdict *v, int32_t precision, const char *what) {
    const double rms = verdict_rms(v), worst = verdict_worst(v), beyond = verdict_beyond(v, 3e-6);
    ck_assert_int_gt(v->count, 0);
    const int fine =
        precision == SKG_PRECISION_DOUBLE ? worst <= 1e-11 : rms <= 3e-7 && beyond <= 1e-3 && worst <= 3e-5;
    ck_assert_msg(fine, "%s, %s: rms %.3g, %.4f %% beyond 3e-6, worst %.3g of Lmax (%.6g mm; %lld pixels)",
                  what, precision == SKG_PRECISION_DOUBLE ? "double" : "single", rms, 100 * beyond, worst,
                  v->longest, (long long)v->count);
}
