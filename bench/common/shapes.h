/* Closed meshes with any number of triangles. */
#ifndef BENCH_SHAPES_H
#define BENCH_SHAPES_H

#include <stdint.h>

enum { SHAPE_SPHERE = 0, SHAPE_BLOB = 1, SHAPE_COUNT };

typedef struct {
    int64_t vertices, triangles;
    float *positions; /* [vertices][3], mm, about the origin */
    int32_t *corners; /* [triangles][3], outward */
} bench_shape;

const char *shape_name(int kind);

/* Rings between two poles. Ring k from a pole has 4 k vertices, which makes the triangles nearly equal; there
 * are 8 n^2 of them, for the n that comes nearest to `triangles`. A blob has bumps of up to a sixth of its
 * radius. */
void shape_make(int kind, double radius, int64_t triangles, bench_shape *shape);
/* Removes the four triangles at one pole, which makes the mesh leaky. */
void shape_cut(bench_shape *shape);
/* Gives every triangle three vertices of its own, as a file of STL does. */
void shape_part(bench_shape *shape);
/* Puts vertices and triangles in random order, the same one in every run. */
void shape_shuffle(bench_shape *shape);
void shape_free(bench_shape *shape);

#endif
