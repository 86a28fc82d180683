/* Minimizing a function of up to 64 numbers between 0 and 1 by a population. */
#include "evolution/search.h"

#include "evolution/methods.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Restarts double the population of CMA up to this many times. */
enum { DOUBLINGS = 4 };

static skg_status allocate(skg_search *s) {
    const int64_t n = s->dimensions, points = s->max_points;
    const int64_t own = s->method == SKG_SEARCH_CMA ? skg_cma_numbers(n) : points * (n + 1);
    s->number_count = 1 + 2 * n + own;
    SKG_TRY(skg_alloc(s->number_count, sizeof *s->numbers, "search", &s->numbers));
    SKG_TRY(skg_alloc(points * n, sizeof *s->points, "search", &s->points));
    SKG_TRY(skg_alloc(points * n, sizeof *s->free_points, "search", &s->free_points));
    s->best_value = s->numbers;
    s->best = s->numbers + 1;
    s->start = s->best + n;
    s->own = s->start + n;
    return SKG_OK;
}

skg_status skg_search_create(int method, int64_t dimensions, const double *start, int64_t seed,
                             skg_search *search) {
    *search = (skg_search){.method = method, .dimensions = dimensions, .seed = seed};
    if (dimensions < 1 || dimensions > SKG_SEARCH_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "a search of %" PRId64 " dimensions; 1 to %d are possible",
                        dimensions, SKG_SEARCH_MAX);
    search->max_points =
        method == SKG_SEARCH_CMA ? skg_cma_population(dimensions, DOUBLINGS) : skg_de_population(dimensions);
    const skg_status status = allocate(search);
    if (status != SKG_OK) {
        skg_search_free(search);
        return status;
    }
    *search->best_value = HUGE_VAL;
    memcpy(search->start, start, (size_t)dimensions * sizeof *start);
    memcpy(search->best, start, (size_t)dimensions * sizeof *start);
    if (method == SKG_SEARCH_CMA)
        skg_cma_begin(search);
    else
        skg_de_begin(search);
    return SKG_OK;
}

void skg_search_free(skg_search *search) {
    skg_free(&search->numbers);
    skg_free(&search->points);
    skg_free(&search->free_points);
}

skg_status skg_search_ask(skg_search *search) {
    if (search->method == SKG_SEARCH_CMA) return skg_cma_ask(search);
    skg_de_ask(search);
    return SKG_OK;
}

skg_status skg_search_tell(skg_search *s, const double *values) {
    const int64_t n = s->dimensions, points = s->counters[SEARCH_POPULATION];
    for (int64_t i = 0; i < points; i++)
        if (values[i] < *s->best_value) {
            *s->best_value = values[i];
            memcpy(s->best, s->points + n * i, (size_t)n * sizeof *s->best);
        }
    s->counters[SEARCH_EVALUATIONS] += points;
    s->counters[SEARCH_GENERATION]++;
    s->counters[SEARCH_SINCE]++;
    if (s->method == SKG_SEARCH_CMA) return skg_cma_tell(s, values);
    skg_de_tell(s, values);
    return SKG_OK;
}
