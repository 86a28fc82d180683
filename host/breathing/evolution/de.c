/* Differential evolution, rand/1/bin (Storn and Price, J. Glob. Optim. 11 (1997) 341-359). */
#include "evolution/methods.h"

#include "evolution/draw.h"

#include <math.h>
#include <string.h>

/* Factor on differences and the share of coordinates that are exchanged: of the usual range 0.5 to 0.9, those that did best
 * on a fit of ten parameters of a liver. */
static const double FACTOR = 0.6, EXCHANGED = 0.9;

enum { PURPOSE_BEGIN = 16, PURPOSE_PARENTS, PURPOSE_COORDINATE, PURPOSE_BOUND };

int64_t skg_de_population(int64_t dimensions) {
    return 4 * dimensions < 8 ? 8 : 4 * dimensions;
}

/* Of `own`: members, then their values. */
static double *members(skg_search *s) {
    return s->own;
}

static double *values_of(skg_search *s) {
    return s->own + s->max_points * s->dimensions;
}

void skg_de_begin(skg_search *s) {
    const int64_t n = s->dimensions;
    s->counters[SEARCH_POPULATION] = s->max_points;
    for (int64_t i = 0; i < s->max_points; i++) {
        const skg_draw_key key = {s->seed, 0, (int32_t)i, PURPOSE_BEGIN};
        for (int64_t k = 0; k < n; k++)
            members(s)[n * i + k] = i == 0 ? s->start[k] : skg_draw_uniform(&key, k);
        values_of(s)[i] = HUGE_VAL;
    }
}

/* Three members other than i and than each other. */
static void choose(const skg_search *s, int64_t i, int64_t chosen[3]) {
    const skg_draw_key key = {s->seed, s->counters[SEARCH_GENERATION], (int32_t)i, PURPOSE_PARENTS};
    int64_t draws = 0;
    for (int c = 0; c < 3;) {
        const int64_t one = (int64_t)(skg_draw_uniform(&key, draws++) * (double)s->max_points);
        int known = one == i;
        for (int d = 0; d < c; d++) known |= chosen[d] == one;
        if (!known) chosen[c++] = one;
    }
}

void skg_de_ask(skg_search *s) {
    const int64_t n = s->dimensions, generation = s->counters[SEARCH_GENERATION];
    for (int64_t i = 0; i < s->max_points; i++) {
        double *point = s->points + n * i;
        const double *own = members(s) + n * i;
        int64_t p[3];
        memcpy(point, own, (size_t)n * sizeof *point);
        if (generation == 0) continue; /* the first members are evaluated as they are */
        choose(s, i, p);
        const skg_draw_key key = {s->seed, generation, (int32_t)i, PURPOSE_COORDINATE};
        const skg_draw_key bound = {s->seed, generation, (int32_t)i, PURPOSE_BOUND};
        const int64_t always = (int64_t)(skg_draw_uniform(&key, n) * (double)n);
        for (int64_t k = 0; k < n; k++) {
            if (k != always && skg_draw_uniform(&key, k) >= EXCHANGED) continue;
            const double *m = members(s);
            const double x = m[n * p[0] + k] + FACTOR * (m[n * p[1] + k] - m[n * p[2] + k]);
            /* Beyond a bound: somewhere between the parent and that bound. */
            const double edge = x < 0 ? 0 : 1;
            point[k] = x >= 0 && x <= 1 ? x : edge + skg_draw_uniform(&bound, k) * (own[k] - edge);
        }
    }
}

void skg_de_tell(skg_search *s, const double *values) {
    const int64_t n = s->dimensions;
    for (int64_t i = 0; i < s->max_points; i++) {
        if (!(values[i] <= values_of(s)[i])) continue;
        values_of(s)[i] = values[i];
        memcpy(members(s) + n * i, s->points + n * i, (size_t)n * sizeof *s->points);
    }
}
