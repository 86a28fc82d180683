/* A slow ray caster in long double: every ray against every triangle. The judge of path lengths.
 *
 * It shares nothing with the library's method. Each ray has a frame of its own, with two axes across the ray
 * and one along it; the ray meets a triangle when the origin lies in the triangle as seen along it. Which
 * side of an edge the origin lies on is decided exactly from the rounded coordinates, and ties are broken by
 * an origin moved by an infinitesimal (Edelsbrunner and Muecke, ACM Trans. Graph. 9, 1990), so signed hits of
 * a closed surface always cancel. */
#ifndef SKG_TESTS_CASTER_H
#define SKG_TESTS_CASTER_H

#include "support/shapes.h"

#include <skiagraph/scene.h>

typedef struct caster caster;

/* pose: [16], row by row; NULL for none. The solid must stay as long as the caster; free with caster_free. */
caster *caster_create(const solid *of, const double *pose);
void caster_free(caster *c);

/* Length in mm within the solid on the way to a place on the detector, in pixels: whole numbers are centres.
 * A place where the signed hits do not cancel is a fault of the solid (it is open): NAN. */
long double caster_length(caster *c, const skg_view *view, long double column, long double row);

/* The least and the greatest length at and around (column, row): the centre and the corners of a square of +-
 * wobble pixels. At a face in the ray's plane the length jumps, and either side counts. */
void caster_range(caster *c, const skg_view *view, int64_t column, int64_t row, double wobble, double *low,
                  double *high);

#endif
