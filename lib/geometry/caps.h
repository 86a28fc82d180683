/* Caps that close a leaky mesh: a fan over each loop of open edges, about the mean of the loop. Private.
 *
 * Mesh and caps together are closed as a sum of signed triangles, whatever is wrong with the mesh, so that the
 * signed hits of every ray cancel. A plane loop is capped by exactly the area that it bounds. A missing triangle
 * and any plane hole are therefore closed exactly, and the gap at a T-junction gets the sliver that is missing.
 * A flipped triangle bounds its loop twice, and the two triangles of its caps outweigh it. Over a loop that is
 * not plane, the fan is one of many possible surfaces. */
#ifndef SKG_CAPS_H
#define SKG_CAPS_H

#include "mesh/mesh.h"

typedef struct {
    int64_t loops;
    int64_t *first;    /* [loops + 1] into vertices */
    int32_t *vertices; /* of the mesh, in the direction of the triangles along each loop */
} skg_caps;

skg_status skg_caps_find(const skg_mesh *mesh, skg_caps *caps);
void skg_caps_release(skg_caps *caps);

#endif
