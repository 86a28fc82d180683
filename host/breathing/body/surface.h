/* Distances over the surface of an organ. Private. */
#ifndef SKG_SURFACE_H
#define SKG_SURFACE_H

#include "body/types.h"

/* The distance of each vertex from the nearest given one, over the surface, in mm; smooth, as rounded edges and ridges
 * of the distance are: over a length of 12 mm (a choice).
 *
 * given     per vertex: 1 where the distance is 0
 * struts    pairs of vertices on both faces of a sheet, over which the way may lead
 * distance  result, per vertex; parts of the surface without a given vertex are far */
skg_status skg_surface_distance(const skg_body_organ *organ, const unsigned char *given, int64_t strut_count,
                                const int32_t *struts, double *distance);

#endif
