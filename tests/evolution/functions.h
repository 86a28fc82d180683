/* Functions whose least value is known, over the box from -5 to 5. */
#ifndef SKG_TESTS_EVOLUTION_FUNCTIONS_H
#define SKG_TESTS_EVOLUTION_FUNCTIONS_H

#include "evolution/search.h"
#include "suite.h"
#include "support/random.h"

#include <math.h>
#include <string.h>

enum { SPHERE, ROSENBROCK, ELLIPSOID, FUNCTIONS };

/* An orthogonal matrix from random rows (Gram and Schmidt). */
static inline void make_rotation(int n, double *q) {
    uint64_t state = 5;
    for (int i = 0; i < n; i++) {
        double length = 0;
        for (int j = 0; j < n; j++) q[n * i + j] = draw(&state, -1, 1);
        for (int p = 0; p < i; p++) {
            double along = 0;
            for (int j = 0; j < n; j++) along += q[n * i + j] * q[n * p + j];
            for (int j = 0; j < n; j++) q[n * i + j] -= along * q[n * p + j];
        }
        for (int j = 0; j < n; j++) length += q[n * i + j] * q[n * i + j];
        for (int j = 0; j < n; j++) q[n * i + j] /= sqrt(length);
    }
}

/* The value at a point of the unit box; q: a rotation. */
static inline double value_of(int function, int n, const double *q, const double *point) {
    double x[SKG_SEARCH_MAX], sum = 0;
    for (int i = 0; i < n; i++) x[i] = -5 + 10 * point[i];
    for (int i = 0; i < n; i++) {
        double y = 0;
        for (int j = 0; j < n; j++) y += q[n * i + j] * (x[j] - 1.3);
        if (function == SPHERE) sum += (x[i] - 1.3) * (x[i] - 1.3);
        if (function == ELLIPSOID) sum += pow(1e6, (double)i / (n - 1)) * y * y;
        if (function == ROSENBROCK && i + 1 < n)
            sum += 100 * pow(x[i] * x[i] - x[i + 1], 2) + pow(x[i] - 1, 2);
    }
    return sum;
}

/* Searches from the middle until the value is small enough; returns the number of evaluations. */
static inline int64_t search_for(int method, int function, int n, int64_t seed, double enough, int64_t most,
                                 skg_search *s) {
    static double q[SKG_SEARCH_MAX * SKG_SEARCH_MAX], values[4096];
    double start[SKG_SEARCH_MAX];
    make_rotation(n, q);
    for (int i = 0; i < n; i++) start[i] = 0.5;
    ck_skg(skg_search_create(method, n, start, seed, s));
    while (s->counters[SEARCH_EVALUATIONS]<most && * s->best_value> enough) {
        ck_skg(skg_search_ask(s));
        for (int64_t i = 0; i < s->counters[SEARCH_POPULATION]; i++)
            values[i] = value_of(function, n, q, s->points + n * i);
        ck_skg(skg_search_tell(s, values));
    }
    return s->counters[SEARCH_EVALUATIONS];
}

#endif
