/* A quadratic model of values seen so far, and its minimum. */
#include "evolution/methods.h"

#include "core/eigen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Dimensions up to which a model is made: its cost grows with their sixth power, 10 ms at 20. */
enum { MODEL_MAX = 20 };

/* Points kept and points fitted, as multiples of the model's terms. With these Rosenbrock's function of search_test.c takes
 * about 5100 evaluations, with 2 and 2.5 times the terms 5300 and 5700. */
static const double KEPT = 3, FITTED = 1.5;

/* Fewer points than this many times the terms make no model. */
static const double LEAST = 1.2;

/* Of a point at the edge of those that are fitted; one at the mean has 1. */
static const double MIN_WEIGHT = 1e-3;

/* Added to the diagonal of the normal equations, as a share of it, so that rounding leaves them positive. */
static const double RIDGE = 1e-10;

/* 1, the coordinates, and their products. */
static int64_t terms_of(int64_t n) {
    return n > MODEL_MAX ? 0 : 1 + n + n * (n + 1) / 2;
}

static int64_t capacity_of(int64_t n) {
    return (int64_t)(KEPT * (double)terms_of(n));
}

int64_t skg_model_numbers(int64_t dimensions) {
    return capacity_of(dimensions) * (dimensions + 1);
}

void skg_model_add(skg_search *s, double *memory, const double *values) {
    const int64_t n = s->dimensions, capacity = capacity_of(n);
    for (int64_t i = 0; i < s->counters[SEARCH_POPULATION] && capacity > 0; i++) {
        if (!isfinite(values[i])) continue;
        double *row = memory + (n + 1) * (s->counters[SEARCH_KEPT]++ % capacity);
        memcpy(row, s->points + n * i, (size_t)n * sizeof *row);
        row[n] = values[i];
    }
}

typedef struct {
    double square; /* of the distance from the mean in the frame */
    int64_t row;
} near_point;

static int by_distance(const void *a, const void *b) {
    const near_point *x = a, *y = b;
    if (x->square != y->square) return x->square < y->square ? -1 : 1;
    return (x->row > y->row) - (x->row < y->row);
}

/* A point in coordinates of the frame; returns the square of its length. */
static double transform(int64_t n, const skg_model_frame *frame, const double *point, double *z) {
    double square = 0;
    for (int64_t k = 0; k < n; k++) {
        z[k] = 0;
        for (int64_t row = 0; row < n; row++)
            z[k] += frame->axes[n * row + k] * (point[row] - frame->mean[row]);
        z[k] /= frame->sigma * frame->lengths[k];
        square += z[k] * z[k];
    }
    return square;
}

/* The normal equations of the terms, and what is solved for. */
typedef struct {
    int64_t terms;
    double *matrix, *right, *term;
} equations;

/* Adds a point at z, with coordinates over `reach`. */
static void add_point(equations *e, int64_t n, const double *z, double reach, double weight, double value) {
    int64_t at = 0;
    e->term[at++] = 1;
    for (int64_t i = 0; i < n; i++) e->term[at++] = z[i] / reach;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j <= i; j++) e->term[at++] = e->term[1 + i] * e->term[1 + j];
    for (int64_t i = 0; i < e->terms; i++) {
        const double weighted = weight * e->term[i];
        double *row = e->matrix + e->terms * i;
        e->right[i] += weighted * value;
        for (int64_t j = 0; j <= i; j++) row[j] += weighted * e->term[j];
    }
}

/* Solves them in place (Cholesky), in one order of sums whatever library is linked. Returns 0 if they have no solution. */
static int solve(equations *e) {
    const int64_t m = e->terms;
    double *a = e->matrix, *b = e->right;
    for (int64_t j = 0; j < m; j++) {
        double pivot = a[m * j + j] * (1 + RIDGE);
        for (int64_t k = 0; k < j; k++) pivot -= a[m * j + k] * a[m * j + k];
        if (!(pivot > 0)) return 0;
        a[m * j + j] = sqrt(pivot);
        for (int64_t i = j + 1; i < m; i++) {
            double sum = a[m * i + j];
            for (int64_t k = 0; k < j; k++) sum -= a[m * i + k] * a[m * j + k];
            a[m * i + j] = sum / a[m * j + j];
        }
    }
    for (int64_t i = 0; i < m; i++) {
        for (int64_t k = 0; k < i; k++) b[i] -= a[m * i + k] * b[k];
        b[i] /= a[m * i + i];
    }
    for (int64_t i = m; i-- > 0;) {
        for (int64_t k = i + 1; k < m; k++) b[i] -= a[m * k + i] * b[k];
        b[i] /= a[m * i + i];
    }
    return 1;
}

/* A quadratic function g z + z H z / 2. H becomes its eigenvectors. */
typedef struct {
    double g[MODEL_MAX], h[MODEL_MAX * MODEL_MAX], along[MODEL_MAX], curvature[MODEL_MAX];
} quadratic;

/* The square of the length of -(H + mu)^-1 g. */
static double square_at(const quadratic *q, int64_t n, double mu) {
    double square = 0;
    for (int64_t k = 0; k < n; k++) square += pow(q->along[k] / (q->curvature[k] + mu), 2);
    return square;
}

/* The multiplier mu of the constraint |z| <= radius, by bisection: lengths fall as it grows. */
static double multiplier_of(const quadratic *q, int64_t n, double radius) {
    double gradient = 0, low, high;
    for (int64_t k = 0; k < n; k++) gradient += q->along[k] * q->along[k];
    low = fmax(0, -q->curvature[0]) + 1e-12 * fmax(fabs(q->curvature[0]), fabs(q->curvature[n - 1]));
    if (square_at(q, n, low) <= radius * radius) return low;
    high = low + sqrt(gradient) / radius;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        *(square_at(q, n, middle) > radius * radius ? &low : &high) = middle;
    }
    return high;
}

/* Takes the coefficients, and finds the minimum. */
static skg_status minimize(const equations *e, int64_t n, double reach, double radius, double *z,
                           int *found) {
    quadratic q;
    const double *at = e->right + 1;
    for (int64_t i = 0; i < n; i++) q.g[i] = *at++ / reach;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j <= i; j++, at++)
            q.h[n * i + j] = q.h[n * j + i] = (i == j ? 2 : 1) * *at / (reach * reach);
    skg_eigen_rising((int)n, q.h, q.curvature);
    for (int64_t k = 0; k < n; k++) {
        q.along[k] = 0;
        for (int64_t row = 0; row < n; row++) q.along[k] += q.h[n * row + k] * q.g[row];
    }
    const double mu = multiplier_of(&q, n, radius);
    *found = 1;
    for (int64_t row = 0; row < n; row++) {
        z[row] = 0;
        for (int64_t k = 0; k < n; k++) z[row] -= q.h[n * row + k] * q.along[k] / (q.curvature[k] + mu);
        *found &= isfinite(z[row]) != 0;
    }
    return SKG_OK;
}

/* Fits the nearest points. Values are taken relative to the nearest one's, which keeps their differences exact. */
static int fit(const skg_search *s, const double *memory, const skg_model_frame *frame, near_point *order,
               int64_t have, equations *e, double *reach) {
    const int64_t n = s->dimensions, wanted = (int64_t)(FITTED * (double)e->terms);
    const int64_t used = wanted < have ? wanted : have;
    double z[MODEL_MAX];
    for (int64_t i = 0; i < have; i++)
        order[i] = (near_point){transform(n, frame, memory + (n + 1) * i, z), i};
    qsort(order, (size_t)have, sizeof *order, by_distance);
    const double far = order[used - 1].square, nearest = memory[(n + 1) * order[0].row + n];
    *reach = sqrt(far);
    if (!(far > 0 && isfinite(far))) return 0;
    for (int64_t i = 0; i < used; i++) {
        const double *row = memory + (n + 1) * order[i].row, inward = 1 - order[i].square / far;
        transform(n, frame, row, z);
        add_point(e, n, z, *reach, inward * inward + MIN_WEIGHT, row[n] - nearest);
    }
    return solve(e);
}

skg_status skg_model_minimum(const skg_search *s, const double *memory, const skg_model_frame *frame,
                             double radius, double *z, int *found) {
    const int64_t n = s->dimensions, terms = terms_of(n), capacity = capacity_of(n);
    const int64_t kept = s->counters[SEARCH_KEPT], have = kept < capacity ? kept : capacity;
    equations e = {.terms = terms};
    near_point *order = NULL;
    double reach;
    skg_status status;
    *found = 0;
    if (terms == 0 || (double)have < LEAST * (double)terms) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(have, sizeof *order, "search", &order));
    SKG_TRY_CLEANUP(skg_alloc(terms * terms, sizeof *e.matrix, "search", &e.matrix));
    SKG_TRY_CLEANUP(skg_alloc(terms, sizeof *e.right, "search", &e.right));
    SKG_TRY_CLEANUP(skg_alloc(terms, sizeof *e.term, "search", &e.term));
    if (fit(s, memory, frame, order, have, &e, &reach))
        SKG_TRY_CLEANUP(minimize(&e, n, reach, radius, z, found));
cleanup:
    skg_free(&order);
    skg_free(&e.matrix);
    skg_free(&e.right);
    skg_free(&e.term);
    return status;
}
