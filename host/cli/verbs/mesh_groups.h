/* Groups of mesh files: listed, and split into a scene. Private to the verb mesh. */
#ifndef CLI_MESH_GROUPS_H
#define CLI_MESH_GROUPS_H

#include "common/args.h"

#include <jansson.h>
#include <skiagraph/skiagraph.h>

/* [{name, triangles}] in the order of the file, each name once. The caller releases it. */
skg_status cli_mesh_groups(const skg_mesh *mesh, json_t **groups);

/* mesh FILE --split DIR [--scene FILE] */
int cli_mesh_split(const cli_arguments *arguments, const skg_mesh_reading *reading);

#endif
