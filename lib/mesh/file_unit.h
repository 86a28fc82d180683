/* The unit of length that a mesh file carries. Private. */
#ifndef SKG_MESH_FILE_UNIT_H
#define SKG_MESH_FILE_UNIT_H

#include <skiagraph/error.h>

#include <stdint.h>
#include <stdio.h>

struct aiScene;

/* mm per unit as the file or its format says; 0: neither does.
 *
 * is_named  the caller names the unit: a length in the file that is none is passed over, and otherwise fails with SKG_ERR_FORMAT */
skg_status skg_mesh_file_unit(const char *path, FILE *stream, int64_t size, int is_named, double *mm);

/* The unit of a file that Assimp has read and whose unit it reports (FBX), mm; 0: none. */
double skg_mesh_scene_unit(const struct aiScene *scene);

/* Whether a file is COLLADA's, whose unit and axes Assimp puts into its root node. */
int skg_mesh_is_collada(const char *path);

#endif
