/* Triangles in the cells of a grid, and whether triangles meet. Private. */
#ifndef SKG_GRID_H
#define SKG_GRID_H

#include "core/core.h"
#include "mesh/mesh.h"

typedef struct {
    int64_t count;
    double *corner; /* [count][9] */
    double low[3], cell;
    int64_t size[3];
    int64_t *first; /* [cells + 1] triangles of cell c are list[first[c]] to list[first[c + 1] - 1] */
    int32_t *list;
} skg_triangle_grid;

/* Bounds of points, widened by `margin` on all sides. */
void skg_grid_bounds(int64_t count, const double *points, double margin, double low[3], double high[3]);

/* Whether two boxes are disjoint. */
int skg_grid_apart(const double *low, const double *high, const double *others_low,
                   const double *others_high);

/* Adds the triangles that reach into a box. Free the grid also after a failure. */
skg_status skg_grid_add(const skg_mesh_arrays *arrays, const double low[3], const double high[3],
                        skg_triangle_grid *grid);
skg_status skg_grid_add_mesh(const skg_mesh *mesh, const double low[3], const double high[3],
                             skg_triangle_grid *grid);

/* Sorts the triangles that were added into cells over a box. */
skg_status skg_grid_sort(const double low[3], const double high[3], skg_triangle_grid *grid);
void skg_grid_free(skg_triangle_grid *grid);

/* Whether a test holds for any triangle of the grid whose bounds touch those of a triangle. number: its place in the
 * order of addition. */
typedef int (*skg_grid_test)(const void *data, const double *triangle, const double *other, int64_t number);
int skg_grid_any(const skg_triangle_grid *grid, const double *triangle, skg_grid_test test, const void *data);

/* Whether a segment passes through a triangle: its ends lie on both sides of the plane, and the crossing lies inside.
 * Triangles are nine coordinates. */
int skg_triangle_pierced(const double *from, const double *to, const double *triangle);

/* Whether an edge of one triangle passes through the other. */
int skg_triangles_meet(const double *a, const double *b);

#endif
