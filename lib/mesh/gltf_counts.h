/* Checks the lengths that the text of a glTF file announces. Private. */
#ifndef SKG_MESH_GLTF_COUNTS_H
#define SKG_MESH_GLTF_COUNTS_H

#include "core/core.h"

/* Fails as skg_mesh_check_counts does.
 *
 * binary   bytes of the chunk of a .glb file that belongs to its first buffer; -1: none */
skg_status skg_mesh_count_gltf(const char *path, int64_t size, const char *text, size_t length,
                               int64_t binary);

#endif
