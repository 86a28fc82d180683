/* Vertices and triangles of a mesh while it is read or made. Private. */
#ifndef SKG_MESH_ARRAYS_H
#define SKG_MESH_ARRAYS_H

#include "core/core.h"

/* The largest number of vertices and of triangles: 3 * count stays below 2^31, so that kernels index with int. */
#define SKG_MESH_LIMIT ((int64_t)(INT32_MAX / 3))

/* Arrays that grow while a file is read; a mesh takes them over and checks the corner numbers. All zero: empty. */
typedef struct {
    double *positions; /* 3 * vertices, mm */
    int32_t *corners;  /* 3 * triangles */
    int64_t vertices, triangles;
    int64_t vertex_capacity, triangle_capacity;
    int32_t as_wound; /* 1: inconsistent winding stays */
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

#endif
