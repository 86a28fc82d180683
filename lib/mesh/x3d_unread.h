/* Refuses X3D files with shapes that Assimp passes over. Private. */
#ifndef SKG_MESH_X3D_UNREAD_H
#define SKG_MESH_X3D_UNREAD_H

#include "core/core.h"

/* Fails with SKG_ERR_FORMAT where shapes lie in a node that is not followed, are wound in two ways by their text, or come out with
 * gaps. text: ends in a zero */
skg_status skg_mesh_check_x3d_unread(const char *path, const char *text);

#endif
