/* Leaky meshes: copies of closed ones that lack triangles. */
#ifndef BENCH_HOLES_H
#define BENCH_HOLES_H

#include "bench.h"

/* A copy without one triangle in `every`. The caller releases it. context: NULL, or the log's. */
skg_mesh *bench_mesh_with_holes(skg_context *context, const skg_mesh *mesh, int every, const char *name);

#endif
