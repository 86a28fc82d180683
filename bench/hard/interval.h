/* The interval of lengths that rays around a pixel have. */
#ifndef BENCH_HARD_INTERVAL_H
#define BENCH_HARD_INTERVAL_H

#include "support/shapes.h"

/* A solid as a view of hard_view sees it. */
typedef struct {
    const solid *of;
    const skg_view *view;
    double *places; /* [vertices][2]: column and row */
    int64_t *first; /* [rows + 1] of each row of pixels in the list */
    int32_t *list;  /* triangles that come within half a pixel of the row */
} hard_sight;

hard_sight hard_see(const solid *s, const skg_view *view);
void hard_sight_free(hard_sight *sight);

/* Range of the exact lengths of the rays to places within `shift` pixels, less than half a pixel, of a pixel, in columns and in rows. */
typedef struct {
    double low, high;    /* least and greatest exact length, mm; NAN if a ray's hits do not cancel */
    int64_t steep_faces; /* faces there whose depth changes by more than 1e-6 of `longest` within the shift */
    double nearest, farthest; /* depths that these faces have there, mm along the ray */
} hard_interval;

/* The edges as seen divide the square of these places into cells, in which the length is a smooth function without
 * extremes. It is therefore taken at the corners of the cells, from inside each, so that the thinnest blade is met. Where
 * edges are very many, some cells stand for all: about `work` triangles are looked at. Ends early when `got` is within
 * `slack` of the interval. */
hard_interval hard_interval_of(const hard_sight *sight, int64_t column, int64_t row, double shift,
                               double longest, double got, double slack, double work);

/* How far a length is from the interval; 0: inside. */
double hard_distance(const hard_interval *interval, double got);

#endif
