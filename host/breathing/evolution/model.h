/* A quadratic model of the function near the mean of CMA-ES, fitted to points that were evaluated before. Its minimum is
 * one point of the next generation: S. Kern, N. Hansen and P. Koumoutsakos, Local meta-models for optimization using
 * evolution strategies, PPSN IX, 939-948 (2006), where the model ranks points; N. Hansen, Injecting external solutions into
 * CMA-ES, arXiv 1110.4181 (2011). Private. */
#ifndef SKG_EVOLUTION_MODEL_H
#define SKG_EVOLUTION_MODEL_H

#include "evolution/state.h"

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
