/* What closes an open mesh: each loop of its open edges is capped by a fan about the loop's mean. Private.
 *
 * Mesh and caps together are closed as a sum of signed triangles, whatever is wrong with the mesh, so that
 * every ray's signed hits cancel. A loop in a plane is capped by exactly the plane area that it bounds: a
 * missing triangle or any plane hole is closed exactly; the gap at a T-junction gets the sliver that it is; a
 * flipped triangle bounds its loop twice and is outweighed by the two triangles of its caps. Over a loop that
 * is not plane the fan is one of many surfaces. */
#ifndef SKG_CAPS_H
#define SKG_CAPS_H

#include "mesh/mesh.h"

typedef struct {
    int64_t loops;
    int64_t *first;    /* [loops + 1] into vertices */
    int32_t *vertices; /* of the mesh, along each loop as its triangles run */
} skg_caps;

skg_status skg_caps_find(const skg_mesh *mesh, skg_caps *caps);
void skg_caps_release(skg_caps *caps);

#endif
