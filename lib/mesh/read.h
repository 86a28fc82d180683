/* What the readers of mesh files share. Private. */
#ifndef SKG_MESH_READ_H
#define SKG_MESH_READ_H

#include "mesh/mesh.h"

/* A file in memory, closed by a zero byte beyond size. name: for messages. */
typedef struct {
    const char *name;
    char *bytes;
    int64_t size;
} skg_mesh_file;

/* Appends. */
skg_status skg_mesh_add_vertex(skg_mesh_arrays *arrays, const double position[3]);

/* A polygon is given corner by corner and cut into a fan from its first: for a plane polygon, convex or not,
 * the signed path lengths of fan and polygon are the same. Zero the struct for each polygon. */
typedef struct {
    int64_t corners;
    int32_t first, last;
} skg_polygon;
skg_status skg_mesh_add_corner(skg_mesh_arrays *arrays, skg_polygon *polygon, int64_t vertex);

/* Readers; numbers in the text are read in the locale of the calling thread, which must be "C". */
skg_status skg_mesh_read_stl(const skg_mesh_file *file, skg_mesh_arrays *arrays);
skg_status skg_mesh_read_obj(const skg_mesh_file *file, skg_mesh_arrays *arrays);
skg_status skg_mesh_read_ply(const skg_mesh_file *file, skg_mesh_arrays *arrays);

#endif
