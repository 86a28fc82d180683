/* The generated thorax before a detector, as scene and as body. */
#ifndef BENCH_THORAX_H
#define BENCH_THORAX_H

#include "bench.h"

typedef struct {
    skg_thorax *thorax;
    int64_t parts, triangles;
    skg_mesh **meshes; /* [parts] the thorax's own, or copies with holes */
} bench_thorax;

/* Which meshes lack every hundredth triangle. */
enum { THORAX_CLOSED = 0, THORAX_LIVER_OPEN = 1, THORAX_ALL_OPEN = 2 };

/* About `triangles` in all. */
void thorax_make(long triangles, int open, bench_thorax *out);
void thorax_free(bench_thorax *thorax);

/* The caller releases what these return. */
skg_body *thorax_body(const bench_thorax *thorax);
/* Of five materials. */
skg_scene *thorax_scene(skg_context *context, const bench_thorax *thorax);
/* Ten energies from 30 to 75 keV, a thousand photons each. */
skg_spectrum *thorax_beam(void);
/* A detector of 480 mm behind the back, size x size pixels, the source 1 m before it. */
void thorax_view(long size, skg_view *view);

#endif
