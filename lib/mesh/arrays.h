/* Vertices and triangles of a mesh while it is read or made. Private. */
#ifndef SKG_MESH_ARRAYS_H
#define SKG_MESH_ARRAYS_H

#include "core/core.h"

/* The largest number of vertices and of triangles: 3 * count stays below 2^31, so that kernels index with int. */
#define SKG_MESH_LIMIT ((int64_t)(INT32_MAX / 3))

/* Where a named piece of a file begins: its triangles go up to the next one. NULL: no name */
typedef struct {
    int64_t first;
    char *object, *group;
} skg_mesh_piece;

/* Arrays that grow while a file is read; a mesh takes them over and checks the corner numbers. All zero: empty. */
typedef struct {
    double *positions; /* 3 * vertices, mm */
    int32_t *corners;  /* 3 * triangles */
    int64_t vertices, triangles;
    int64_t vertex_capacity, triangle_capacity;
    int32_t as_wound;    /* 1: inconsistent winding stays */
    double file_unit_mm; /* mm per unit that the file names; 0: none */
    double unit_mm;      /* mm per unit that was used; 0: made in mm */
    int32_t unit_from;   /* enum skg_unit_from */
    int64_t trailing;    /* bytes behind the last triangle of a binary file */
    int64_t not_printed; /* objects of a 3MF file that support others */
    skg_mesh_piece *pieces;
    int64_t piece_count, piece_capacity;
    int64_t unused;   /* vertices of no triangle, which were left out */
    int64_t left_out; /* points and lines that a file has, and a mesh has not */
} skg_mesh_arrays;

void skg_mesh_arrays_free(skg_mesh_arrays *arrays);

/* Appends a vertex. */
skg_status skg_mesh_add_vertex(skg_mesh_arrays *arrays, const double position[3]);

/* A polygon is given corner by corner and cut into a fan from its first corner. For a plane polygon, convex or not,
 * the signed path lengths through the fan and through the polygon are the same. Zero the struct for each polygon. */
typedef struct {
    int64_t corners;
    int32_t first, last;
} skg_polygon;
skg_status skg_mesh_add_corner(skg_mesh_arrays *arrays, skg_polygon *polygon, int64_t vertex);

/* Begins a named piece: an object, or a group of the object at hand. */
skg_status skg_mesh_begin_object(skg_mesh_arrays *arrays, const char *name);
skg_status skg_mesh_begin_group(skg_mesh_arrays *arrays, const char *name);

/* The name by which a piece is listed: its group's, otherwise its object's; NULL: none. */
const char *skg_mesh_piece_name(const skg_mesh_piece *piece);

/* Leaves out the vertices that no triangle uses, which would count in bounds, and counts them; the others keep their order. */
skg_status skg_mesh_drop_unused(skg_mesh_arrays *arrays, const char *path);

/* Keeps the triangles of the pieces whose object or group has this name. */
skg_status skg_mesh_keep_group(skg_mesh_arrays *arrays, const char *path, const char *name);

#endif
