#ifndef SKG_CLI_MESHES_H
#define SKG_CLI_MESHES_H

#include "breathe/fluoroscopy.h"

/* Writes "LABEL-0042.ply" for every part that moves, with the displacement of each vertex in mm. Returns an
 * exit status and prints the error. */
int meshes_write(const fluoroscopy *f, const char *folder, int64_t frame);

#endif
