/* Refuses glTF files with elements that move vertices and that Assimp passes over. Private. */
#ifndef SKG_MESH_GLTF_UNREAD_H
#define SKG_MESH_GLTF_UNREAD_H

#include "core/core.h"

#include <jansson.h>

/* The element of the list `list` that `name` names: by its number in version 2, by its name in version 1. NULL: none */
json_t *skg_gltf_find(json_t *root, const char *list, const json_t *name);

/* Fails with SKG_ERR_FORMAT where a file (1 or 2) requires an extension that is not applied, has positions that are not floats, or
 * nodes with skins, morph targets of other weights than 0, or instances by an extension. */
skg_status skg_mesh_check_gltf_unread(const char *path, json_t *root);

#endif
