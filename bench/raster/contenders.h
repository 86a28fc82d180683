/* The contenders. All compute the same image: path lengths in mm, floats in host memory, of one closed mesh
 * around the origin. What does not depend on the view is computed beforehand. */
#ifndef BENCH_CONTENDERS_H
#define BENCH_CONTENDERS_H

#include "common/bench.h"
#include "common/shapes.h"

typedef struct scanline scanline;
typedef struct embree embree;
typedef struct library library;

/* Plain C with OpenMP, by scan lines: the library's method (docs/numerics.md). */
scanline *scanline_create(const bench_shape *shape, const skg_view *view, int threads, float *lengths);
void scanline_frame(void *contender);
void scanline_free(scanline *contender);

/* Embree 3: every hit of packets of 16 rays, collected by a filter function. Built only if Embree is found. */
embree *embree_create(const bench_shape *shape, const skg_view *view, int threads, float *lengths);
void embree_frame(void *contender);
void embree_free(embree *contender);

/* The library, through its public interface. */
library *library_create(skg_context *context, const bench_shape *shape, const skg_view *view, float *lengths);
void library_frame(void *contender);
void library_free(library *contender);

#endif
