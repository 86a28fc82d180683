/* What the files of the stage `gradient` share. Private. */
#ifndef SKG_GRADIENT_PRIVATE_H
#define SKG_GRADIENT_PRIVATE_H

#include "stage/gradient.h"
#include "stage/raster_private.h"

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

/* Begins a gather: its program and arguments. */
skg_status skg_gather_begin(skg_gather_run *run);

/* Waits for the weights. most: [planes] result: the largest of each plane. */
skg_status skg_gather_find_max(const skg_gather_run *run, double *most);

/* The same number of reals in the precision of the pass. reals: filled from number `first` on */
void skg_gather_round(const skg_gather_run *run, int64_t first, int64_t count, const double *numbers,
                      void *reals);
skg_status skg_gather_upload_scales(const skg_gather_run *run, int64_t count, const double *scales);
skg_status skg_gather_reserve(const skg_gather_run *run, skg_buffer *buffer, int64_t bytes);

/* Makes sure of `end` sums, of which those from number `first` on are 0. */
skg_status skg_gather_clear(const skg_gather_run *run, int64_t first, int64_t end);

/* What priorities add to the weights of hits; the hits of competing parts are listed still, by skg_hits_settle of this pass. */
skg_status skg_gather_slopes(const skg_gather_run *run);

/* Adds what batches have not, by gradient.cl: all faces, or what priorities add. */
skg_status skg_gather_faces(const skg_gather_run *run);

/* Powers of two by which weights become integers, and what a moment of 1 is worth. most: [planes] the largest weights. around: NULL, or what
 * stands around the parts. scales: [2][parts]; units: [2][parts] */
void skg_gradient_find_scales(const skg_gather_run *run, const double *most, const skg_surroundings *around,
                              double *scales, double *units);

/* One scale for the hits of the parts that move, whose slopes are at most `slope`; 0: all derivatives are 0. scales: [parts], 0 of
 * those that do not */
double skg_gradient_find_scale(const skg_gather_run *run, const double *most, const uint8_t *moves,
                               double slope, double *scales);

/* The first triangle of a part, over all parts, and that behind its last: those of the part before end where it begins. */
static inline int64_t skg_gradient_part_end(const skg_geometry *geometry, int64_t part, int64_t first) {
    return first + geometry->layouts[geometry->mesh_of_part[part]].triangles;
}

/* What a unit of the contributions of a part is on the device: they weigh q = r / reference, with a parallel beam r. */
double skg_gradient_depth_unit(const skg_gather_run *run, int64_t part);

#endif
