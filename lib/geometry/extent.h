/* Where a part can come to lie on the detector and along the rays: what scale and warnings are decided from.
 * Private. */
#ifndef SKG_EXTENT_H
#define SKG_EXTENT_H

#include "geometry/camera.h"
#include "geometry/scale.h"
#include "mesh/mesh.h"

typedef struct {
    skg_scale_part scale; /* its weight is the caller's to fill */
    int32_t near_source;  /* may reach the source's plane, or where parallel rays start */
    int32_t on_detector;  /* its rectangle meets the detector, between where rays start and end */
} skg_extent;

/* From the mesh's bounds as they stand, under a pose. */
void skg_extent_find(const skg_camera *camera, const skg_mesh *mesh, const double *pose, skg_extent *extent);

/* The field (skg_shared.h) that its rectangle and 2 pixels for rounding cover; rows may lie beyond the last
 * one. */
void skg_extent_pixels(const skg_camera *camera, const skg_extent *extent, int32_t pixels[4]);

#endif
