/* The readers of mesh files. Private. */
#ifndef SKG_MESH_READ_H
#define SKG_MESH_READ_H

#include "mesh/arrays.h"

#include <stdio.h>

/* A file in memory. A zero byte follows the last one. */
typedef struct {
    const char *name; /* for messages */
    char *bytes;
    int64_t size;
} skg_mesh_file;

/* Each appends what the file holds. Numbers in the text are read with the locale of the calling thread, which must be
 * "C". */
skg_status skg_mesh_read_stl(const skg_mesh_file *file, skg_mesh_arrays *arrays);
skg_status skg_mesh_read_obj(const skg_mesh_file *file, skg_mesh_arrays *arrays);
skg_status skg_mesh_read_off(const skg_mesh_file *file, skg_mesh_arrays *arrays);
skg_status skg_mesh_read_ply(const skg_mesh_file *file, skg_mesh_arrays *arrays);

/* Reads a 3MF file, which is an archive. */
skg_status skg_mesh_read_3mf(FILE *stream, const char *path, int64_t size, skg_mesh_arrays *arrays);

#endif
