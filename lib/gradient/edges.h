/* The worth of faces that rays contain: d loss / d t at a pixel, from the weights of a pass. Private.
 *
 * Where parts compete by priority, it depends on depth. A face of part a separates places inside a from places outside. With T(in) and
 * T(out) for what the parts that lose there take off, for a unit of length, the worth is that of a's own length - T(in) + T(out).
 * The lists of hits (kernels/raster/hits.cl) do not suffice: they lack the background where no winner is hit. So the host traces the ray
 * to the middle of what the pixel sees of the face through all that compete. */
#ifndef SKG_GRADIENT_EDGES_H
#define SKG_GRADIENT_EDGES_H

#include "gradient/edge_volumes.h"

/* The weights of a pass on the host, and what competes there. */
typedef struct {
    skg_edge_planes read;
    skg_crossings *competitors; /* [pass->priority.count] NULL: no competitor has had such a face so far */
    int32_t *slots, *table;     /* of skg_priority_tables, with competitors */
    skg_edge_volumes volumes;   /* that compete, with competitors */
} skg_edge_weights;

/* The weights of one part: the `user` of skg_edge_weigh. */
typedef struct {
    const skg_edge_weights *all;
    int64_t part;
} skg_part_edges;

skg_status skg_edge_weights_create(const skg_pass *pass, skg_edge_weights *w);

/* Forgets the weights that were read. It has to be called before those on the device change; release calls it, too. */
void skg_edge_weights_clear(skg_edge_weights *w);
void skg_edge_weights_release(skg_edge_weights *w);

/* Reads what skg_edge_weigh needs for a part, if it is not read. */
skg_status skg_edge_weights_read(skg_job *job, int64_t part, skg_edge_weights *w);

/* A skg_steep_weigh for skg_part_edges. Several threads may call it at a time. */
skg_status skg_edge_weigh(const void *user, int64_t column, int64_t row, const double middle[2],
                          skg_steep_weights *weights);

#endif
