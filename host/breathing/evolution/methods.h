/* The state of a search and its two methods, CMA-ES and differential evolution. Private. */
#ifndef SKG_EVOLUTION_METHODS_H
#define SKG_EVOLUTION_METHODS_H

#include "core/core.h"

enum skg_search_method { SKG_SEARCH_CMA = 0, SKG_SEARCH_DE = 1 };

enum { SKG_SEARCH_MAX = 64 }; /* dimensions */

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
    int64_t dimensions, max_points, seed;
    int64_t counters[SEARCH_COUNTERS];
    int64_t number_count;
    double *numbers;     /* [number_count] what the pointers below point into */
    double *best_value;  /* least value so far; HUGE_VAL: none */
    double *best;        /* [dimensions] its point */
    double *start;       /* [dimensions] */
    double *own;         /* the method's */
    double *points;      /* [max_points][dimensions] after ask: where f is wanted, in the box */
    double *free_points; /* [max_points][dimensions] of CMA: the same before they were moved into the box */
} skg_search;

/* CMA-ES. */

/* Length of skg_search.own. */
int64_t skg_cma_numbers(int64_t dimensions);

/* Points of a generation after so many restarts. */
int64_t skg_cma_population(int64_t dimensions, int64_t restarts);

void skg_cma_begin(skg_search *search);
skg_status skg_cma_ask(skg_search *search);
skg_status skg_cma_tell(skg_search *search, const double *values);

/* Differential evolution. */

int64_t skg_de_population(int64_t dimensions);
void skg_de_begin(skg_search *search);
void skg_de_ask(skg_search *search);
void skg_de_tell(skg_search *search, const double *values);

/* A quadratic model of the function near the mean of CMA-ES, fitted to points that were evaluated before. Its minimum is
 * one point of the next generation: S. Kern, N. Hansen and P. Koumoutsakos, Local meta-models for optimization using
 * evolution strategies, PPSN IX, 939-948 (2006), where the model ranks points; N. Hansen, Injecting external solutions into
 * CMA-ES, arXiv 1110.4181 (2011). */

/* The coordinates of a model: those in which CMA-ES draws round distributions. */
typedef struct {
    const double *mean, *axes, *lengths;
    double sigma;
} skg_model_frame;

/* Length of the memory for points with their values; 0 if there are too many dimensions for a model. */
int64_t skg_model_numbers(int64_t dimensions);

/* Puts a generation into the memory, instead of the oldest points. */
void skg_model_add(skg_search *search, double *memory, const double *values);

/* Where the model is least within `radius` of the mean, in coordinates of the frame. found: 0 if there are too few points. */
skg_status skg_model_minimum(const skg_search *search, const double *memory, const skg_model_frame *frame,
                             double radius, double *z, int *found);

#endif
