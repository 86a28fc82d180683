/* The state of a search, which its methods share. Private. */
#ifndef SKG_EVOLUTION_STATE_H
#define SKG_EVOLUTION_STATE_H

#include "core/core.h"

enum skg_search_method { SKG_SEARCH_CMA = 0, SKG_SEARCH_DE = 1 };

enum { SKG_SEARCH_MOST = 64 }; /* dimensions */

/* Of `counters`. */
enum {
    SEARCH_GENERATION,  /* from 0, never reset */
    SEARCH_EVALUATIONS, /* of f */
    SEARCH_RESTARTS,
    SEARCH_SINCE, /* generations since the start or the last restart */
    SEARCH_POPULATION,
    SEARCH_KEPT, /* points that a model of CMA-ES has taken since then */
    SEARCH_COUNTERS
};

typedef struct {
    int method;
    int64_t dimensions, most_points, seed;
    int64_t counters[SEARCH_COUNTERS];
    int64_t number_count;
    double *numbers;     /* [number_count] what the pointers below point into */
    double *best_value;  /* least value so far; HUGE_VAL: none */
    double *best;        /* [dimensions] its point */
    double *start;       /* [dimensions] */
    double *own;         /* the method's */
    double *points;      /* [most_points][dimensions] after ask: where f is wanted, in the box */
    double *free_points; /* [most_points][dimensions] of CMA: the same before they were moved into the box */
} skg_search;

#endif
