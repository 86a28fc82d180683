/* How the components of a mesh lie in each other. Private. */
#ifndef SKG_NESTING_H
#define SKG_NESTING_H

#include <skiagraph/mesh.h>

/* As skg_mesh_nesting_get, and which triangles a turn concerns.
 *
 * turned   [triangles] 1: of an inverted component; may be NULL */
skg_status skg_nesting_find(const skg_mesh *mesh, skg_mesh_nesting *nesting, unsigned char *turned);

#endif
