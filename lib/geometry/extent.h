/* The bounds of a part on the detector and along the rays. Scale, extents of planes and warnings follow from them.
 * Private. */
#ifndef SKG_EXTENT_H
#define SKG_EXTENT_H

#include "geometry/camera.h"
#include "geometry/scale.h"
#include "mesh/mesh.h"

typedef struct {
    skg_scale_part scale; /* the caller fills its weight */
    int32_t near_source; /* 1: it may reach the plane of the source, or the plane where parallel rays start */
    int32_t on_way;      /* 1: some of it, or a flat part, lies between the start and the end of the rays */
    int32_t on_detector; /* 1: its rectangle meets the detector, between the start and the end of the rays */
} skg_extent;

/* The extent of a mesh at a pose, from the present bounds of the mesh.
 *
 * last_bit   of the device's numbers relative to 1: FLT_EPSILON or DBL_EPSILON. Depths are widened by what these numbers
 *            round where that matters for the sums: of parts that are as thin, or reach as little into the path */
void skg_extent_find(const skg_camera *camera, const skg_mesh *mesh, const double *pose, double last_bit,
                     skg_extent *extent);

/* The same from other bounds, mm from the mesh's origin. */
void skg_extent_find_within(const skg_camera *camera, const skg_mesh *mesh, const float lowest[3],
                            const float highest[3], const double *pose, double last_bit, skg_extent *extent);

/* The pixels that its rectangle and 2 pixels more for rounding cover: rows from, to, columns from, to, rounded
 * outward as skg_shared.h wants them. The last row may lie beyond the detector. */
void skg_extent_pixels(const skg_camera *camera, const skg_extent *extent, int32_t pixels[4]);

/* Widens pixels by those of another extent. All 0: there are none so far. */
void skg_extent_join(int32_t pixels[4], const int32_t more[4]);

#endif
