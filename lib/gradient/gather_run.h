/* One run of a gather: what it reads and writes. Private. */
#ifndef SKG_GATHER_RUN_H
#define SKG_GATHER_RUN_H

#include "gradient/device.h"
#include "stage/raster_private.h"

enum { SKG_GATHER_CLAIM = 1024 }; /* triangles that a work-item of a processor takes in a row */

/* One gather. */
typedef struct {
    const skg_pass *pass;
    const skg_geometry *geometry;
    const skg_hits_memory *hits;
    skg_gradient_memory *memory;
    skg_staging *staging;
    const skg_raster *raster;
    skg_context *context;
    cl_program program;
    skg_gradient_args args;
    int32_t is_double;
    int32_t forward; /* 1: derivatives of pixels */
    /* Work-items of a processor that draw batches of faces, each with its own sums of pixels if `forward`; what priorities add is added
     * by itself. 0: gradient.cl draws all */
    int64_t workers;
    const skg_surroundings *around; /* NULL: lengths are not weighed by it */
} skg_gather_run;

/* A gather of these. */
static inline skg_gather_run skg_gather_of(const skg_pass *pass, const skg_geometry *geometry,
                                           const skg_hits_memory *hits, skg_gradient_memory *memory,
                                           skg_staging *staging) {
    return (skg_gather_run){.pass = pass,
                            .geometry = geometry,
                            .hits = hits,
                            .memory = memory,
                            .staging = staging,
                            .raster = pass->main.raster,
                            .context = pass->main.raster->context,
                            .is_double = geometry->precision == SKG_PRECISION_DOUBLE};
}

/* The first triangle of a part, over all parts, and that behind its last: those of the part before end where it begins. */
static inline int64_t skg_gradient_part_end(const skg_geometry *geometry, int64_t part, int64_t first) {
    return first + geometry->layouts[geometry->mesh_of_part[part]].triangles;
}

#endif
