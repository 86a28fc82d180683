/* Closed triangle meshes of any fineness. */
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

/* Rings between two poles, as many vertices on a ring as its distance to the next pole calls for: nearly even
 * triangles, 8 n^2 of them for the n that comes nearest to `triangles`. A blob has bumps of a sixth of its
 * radius. */
void shape_make(int kind, double radius, int64_t triangles, bench_shape *shape);
/* Without the triangles of one cap of the pole: an open mesh. */
void shape_open(bench_shape *shape);
void shape_free(bench_shape *shape);

#endif
