/* Keeping surfaces apart. The regions that shape the organs keep gaps where they are sampled. Between the samples a
 * facet may still cut into a neighbour; it then draws back. Private. */
#ifndef SKG_RETREAT_H
#define SKG_RETREAT_H

#include "mesh/mesh.h"

/* Draws a surface back, along its normals, where it meets `count` other meshes or comes nearer to them than 0.2 mm,
 * until it does not; at most 15 mm. */
skg_status skg_shape_retreat(const char *name, int64_t count, skg_mesh *const *others,
                             skg_mesh_arrays *arrays);

#endif
