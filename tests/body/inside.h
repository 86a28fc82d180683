/* Whether points lie in a closed mesh, and how deep: for tests only. */
#ifndef SKG_TESTS_INSIDE_H
#define SKG_TESTS_INSIDE_H

#include <skiagraph/mesh.h>

typedef struct {
    int64_t vertices, triangles;
    double *position;
    int32_t *corner;
    double low[3], high[3];
    int32_t *first, *list; /* triangles by column of a grid over x and y */
} solid;

enum { SOLID_GRID = 48 };

void solid_make(const skg_mesh *mesh, solid *s);
void solid_free(solid *s);

/* 1 when an upward ray meets the surface an odd number of times. */
int solid_holds(const solid *s, const double p[3]);

/* Distance to the nearest triangle, mm. */
double solid_distance(const solid *s, const double p[3]);

/* The deepest that a vertex of a (every `stride`th) lies in b: mm, 0 when none does. */
double solid_overlap(const solid *a, const solid *b, int64_t stride);

#endif
