/* The generated thorax in front of a detector, as a scene and as a body. */
#ifndef BENCH_THORAX_H
#define BENCH_THORAX_H

#include "bench.h"

#include <skiagraph/breathing.h>

typedef struct {
    skg_thorax *thorax;
    int64_t parts, triangles;
    skg_mesh **meshes; /* [parts] the thorax's own, or copies with holes */
} bench_thorax;

/* Which meshes lack every hundredth triangle. */
enum { THORAX_CLOSED = 0, THORAX_LEAKY_LIVER = 1, THORAX_ALL_LEAKY = 2 };

/* triangles: the approximate number in total; leaky: THORAX_... */
void thorax_make(long triangles, int leaky, bench_thorax *out);
void thorax_free(bench_thorax *thorax);

/* The caller releases the results. */
skg_body *thorax_body(const bench_thorax *thorax);
/* Of five materials. */
skg_scene *thorax_scene(skg_context *context, const bench_thorax *thorax);
/* Ten energies from 30 to 75 keV, a thousand photons each. */
skg_spectrum *thorax_beam(void);
/* A detector of 480 mm and size x size pixels behind the back, with the source 1 m in front of it. */
void thorax_view(long size, skg_view *view);

#endif
