/* Those who compute the same image of path lengths: one closed mesh about the origin, float lengths in mm in
 * host memory, everything that does not depend on the view done beforehand. */
#ifndef BENCH_CONTENDERS_H
#define BENCH_CONTENDERS_H

#include "common/bench.h"
#include "common/shapes.h"

typedef struct scanline scanline;
typedef struct embree embree;
typedef struct library library;

/* Plain C and OpenMP, by scan lines (numerics of the library's own method). */
scanline *scanline_create(const bench_shape *shape, const skg_view *view, int threads, float *lengths);
void scanline_frame(void *contender);
void scanline_free(scanline *contender);

/* Embree 3: every hit of packets of 16 rays, collected by a filter function. Built only where Embree is
 * found. */
embree *embree_create(const bench_shape *shape, const skg_view *view, int threads, float *lengths);
void embree_frame(void *contender);
void embree_free(embree *contender);

/* The library, by its public interface. config: as skg_context_create takes it. One context serves all. */
library *library_create(skg_context *context, const bench_shape *shape, const skg_view *view, float *lengths);
void library_frame(void *contender);
void library_free(library *contender);

#endif
