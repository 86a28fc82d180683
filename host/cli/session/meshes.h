/* Meshes instead of a scene file: the scene that the flags describe. */
#ifndef SKG_CLI_MESHES_H
#define SKG_CLI_MESHES_H

#include "common/args.h"

/* Whether the operands are meshes: --material is given. */
int cli_has_meshes(const cli_arguments *arguments);

/* Checks the number of operands, and that the flags of meshes are given with meshes only. Returns an exit status and
 * prints the error. */
int cli_check_operands(const cli_arguments *arguments);

/* The JSON text of a scene of the operands, which the caller frees. Returns an exit status and prints the error. */
int cli_scene_of_meshes(const cli_arguments *arguments, char **text);

#endif
