/* Parts as closed surfaces in world coordinates. Private. */
#ifndef SKG_SOLIDS_H
#define SKG_SOLIDS_H

#include "geometry/columns.h"
#include "mesh/mesh.h"

/* Places a mesh. A leaky one gives a solid without triangles.
 *
 * inside      the parent's number, or -1
 * positions   result: [vertices][3] the caller frees it after the solid's last use; NULL of a leaky mesh */
skg_status skg_solid_place(const skg_mesh *mesh, const double pose[16], int64_t inside, skg_solid *solid,
                           double **positions);

#endif
