/* The slopes of faces of a pass along directions, one after another: how fast hits with the parts that move go along their rays.
 * Private. */
#ifndef SKG_DERIVATIVE_SLOPES_H
#define SKG_DERIVATIVE_SLOPES_H

#include "gradient/edges.h"
#include "gradient/slopes.h"

/* Consecutive faces of a part, and the slopes at their corners. */
typedef struct {
    int64_t part, first, end;
    double sum, largest; /* of their magnitudes */
    int64_t used, cut;   /* those that are not 0; those that were cut off */
} skg_slope_range;

/* A direction in a pass. */
typedef struct {
    const skg_direction *direction;
    skg_velocities of_view; /* of source, detector and beam */
} skg_pass_direction;

/* The parts that move along any direction. */
typedef struct {
    const skg_pass *pass;
    int64_t count;
    const skg_pass_direction *directions; /* [count] */
    skg_face_moments *faces;              /* [parts] */
    skg_part_edges *edges;                /* [parts] */
    skg_edge_weights of_edges;
    uint8_t *moves;       /* [parts] along any direction */
    uint8_t *moves_now;   /* [parts] along that of the last call of skg_slopes_make */
    skg_seen_faces *seen; /* [parts] those of parts that move lie in one block */
    void *block;
    skg_slope_range *ranges;
    int64_t range_count;
    int64_t *first; /* [parts] the first triangle, over all parts */
    int32_t is_seen;
    int32_t reserved;
} skg_moving_parts;

/* Finds out which parts move. Release it, also after a failure, by skg_moving_parts_release. */
skg_status skg_moving_parts_create(skg_job *job, const skg_pass *pass, int64_t count,
                                   const skg_pass_direction *directions, skg_moving_parts *moving);
void skg_moving_parts_release(skg_moving_parts *moving);

/* How a part moves along a direction. */
skg_velocities skg_moving_velocities(const skg_moving_parts *moving, int64_t direction, int64_t part);

/* Makes the slopes of the faces of the parts that move along a direction, times the part's reference, in the order of the device:
 * rounded, in skg_gradient_memory.reals. Those above 2^24 times their mean are cut off there, because sums over hits are 64-bit integers.
 *
 * largest     result
 * saturated   the number of those that were cut off is added to it */
skg_status skg_slopes_make(skg_job *job, skg_moving_parts *moving, int64_t direction, double *largest,
                           int64_t *saturated);

#endif
