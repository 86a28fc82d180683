/* Pieces of which bodies are made: they append vertices and triangles to arrays that have room for them. Private. */
#ifndef SKG_MESH_PIECES_H
#define SKG_MESH_PIECES_H

#include "mesh/arrays.h"

skg_status skg_check_length(const char *shape, const char *what, double length);
skg_status skg_check_count(const char *shape, const char *what, int64_t count, int64_t fewest, int64_t most);

/* Room for this many vertices and triangles; the arrays are empty after a failure. */
skg_status skg_pieces_start(const char *shape, int64_t vertices, int64_t triangles, skg_mesh_arrays *arrays);

void skg_add_vertex(skg_mesh_arrays *arrays, double x, double y, double z);
void skg_add_triangle(skg_mesh_arrays *arrays, int64_t a, int64_t b, int64_t c);

/* The corners run counter-clockwise as seen from outside. */
void skg_add_quad(skg_mesh_arrays *arrays, int64_t a, int64_t b, int64_t c, int64_t d);

/* A cuboid: 8 vertices and 12 triangles. */
void skg_add_cuboid(skg_mesh_arrays *arrays, const double low[3], const double high[3]);

/* Triangles from a vertex to a ring of vertices, and between two rings. up: the vertex is above the ring. */
void skg_add_fan(skg_mesh_arrays *arrays, int64_t hub, int64_t ring, int64_t segments, int up);
void skg_add_wall(skg_mesh_arrays *arrays, int64_t lower, int64_t upper, int64_t segments);

/* A sphere: 2 + (bands - 1) segments vertices, 2 (bands - 1) segments triangles, with half as many bands as segments. */
void skg_add_sphere(skg_mesh_arrays *arrays, const double centre[3], double radius, int64_t segments);
int64_t skg_sphere_rings(int64_t segments);

#endif
