/* Rays through one part, traced on the host in double. Private. */
#ifndef SKG_TRACER_H
#define SKG_TRACER_H

#include "geometry/camera.h"
#include "scene/scene.h"

/* The most rays along each side of a grid. */
enum { SKG_TRACED_SIDE = 64 };

/* A part as a camera sees it, and a grid of rays through it. */
typedef struct {
    const skg_camera *camera;
    const skg_mesh *mesh;
    int32_t near_source, reserved; /* 1: signed hits may be left over, since paths start inside */
    double (*seen)[6];             /* [vertices] x, y, w and path parameter; column and row where w > 0 */
    int64_t side;                  /* rays along each side of the grid */
    double column, row;            /* of the first ray, in pixels */
    double column_step, row_step;
    double *lengths; /* [side][side] mm, signed; 0 where the signed hits of a leaky mesh do not cancel */
    int32_t *counts; /* [side][side] signed hits */
    int32_t *met;    /* [side][side] hits */
    int64_t hits;
} skg_tracer;

/* *tracer is released by skg_tracer_release, after a failure too. It keeps the addresses that it is given. */
skg_status skg_tracer_open(const skg_camera *camera, const skg_scene_part_data *part, int near_source,
                           skg_tracer *tracer);
void skg_tracer_release(skg_tracer *tracer);

/* Lays side x side rays over the rectangle from low to high (column, row), and traces them. No ray: the rectangle is
 * empty. */
void skg_tracer_trace(skg_tracer *tracer, int64_t side, const double low[2], const double high[2]);

/* The same over the whole detector. */
void skg_tracer_trace_detector(skg_tracer *tracer, int64_t side);

/* The longest ray to a pixel for a path parameter of 1, mm. */
double skg_ray_longest(const skg_camera *camera);

/* The way of the rays of such a grid over the detector in mm: [side][side]. */
void skg_ways_find(const skg_camera *camera, int64_t side, double *ways);

#endif
