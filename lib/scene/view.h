/* The geometry of a view in double, as the projection stage needs it (numerics.md 2, contracts.md 3).
 * Private.
 *
 * Pixel (column i, row j), counted from 0 with integers at pixel centres, is at pixel0 + i du + j dv. A point
 * X of the world projects by h = m (X - origin):
 *   point source: m = [du dv d0]^-1, origin = source, d0 = pixel0 - source. i = h0/h2, j = h1/h2, and t = h2
 *     is the way along the ray: 0 at the source's plane (parallel to the detector), 1 at the pixel.
 *     D(i,j) = d0 + i du + j dv runs from the source to the pixel; a stretch dt of the ray is |D(i,j)| dt mm.
 *   parallel beam: m = [du dv d]^-1 with the beam's direction d of length 1, origin = pixel0. i = h0, j = h1,
 *     and s = h2 is the way along the ray in mm: 0 at the detector, negative before it. Rays start where
 *     s = start[0] + i start[1] + j start[2] (the plane through the source across d). */
#ifndef SKG_VIEW_H
#define SKG_VIEW_H

#include "core/core.h"

#include <skiagraph/scene.h>

typedef struct {
    double m[9];      /* row by row */
    double origin[3]; /* mm */
    double pixel0[3]; /* centre of pixel (0, 0), mm */
    double du[3];     /* column step, mm */
    double dv[3];     /* row step, mm */
    double d0[3];     /* point source: source to pixel (0, 0), mm; parallel: the direction, length 1 */
    double start[3];  /* parallel: where rays start, mm (start[0] = -infinity: no start); point source: 0 */
    double normal[3]; /* of the detector, length 1, pointing away from the source */
    int32_t parallel; /* 1 or 0 */
    int64_t columns, rows;
} skg_view_frame;

/* Checks a view and works its geometry out. SKG_ERR_SCENE with the reason; see skg_view_check. */
skg_status skg_view_prepare(const skg_view *view, skg_view_frame *frame);

/* h = m (X - origin). The translation of a part goes into X; a vector (an offset from the part's origin) is
 * projected by m alone. */
void skg_view_project(const skg_view_frame *frame, const double *x, double *h);

/* |D(i,j)|: mm per unit of h2 along the ray of a pixel; 1 for a parallel beam. i and j may lie between pixels
 * or off the detector. */
double skg_view_distance(const skg_view_frame *frame, double i, double j);

/* Where the ray of a pixel starts, in units of h2: 0 for a point source. The ray ends at 1 for a point
 * source, at 0 for a parallel beam. */
double skg_view_start(const skg_view_frame *frame, double i, double j);

#endif
