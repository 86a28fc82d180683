/* Checks the lengths that a file announces, before Assimp opens it: Assimp allocates memory for every announced length, and follows parts
 * that contain themselves until the stack ends. Private. */
#ifndef SKG_MESH_COUNTS_H
#define SKG_MESH_COUNTS_H

#include "core/core.h"

#include <stdio.h>

/* Fails with SKG_ERR_FORMAT where a file of glTF 1 and 2 (also binary), COLLADA, AMF or X3D places its parts in circles, more
 * than SKG_INSTANCES_MAX times or too deep, announces lengths that its bytes do not have, or would take too much memory. Files
 * of other kinds pass. */
skg_status skg_mesh_check_counts(const char *path, FILE *stream, int64_t size);

#endif
