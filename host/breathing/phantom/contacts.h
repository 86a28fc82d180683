/* Surfaces that fold over themselves or meet others, and how they are parted. Private. */
#ifndef SKG_PHANTOM_CONTACTS_H
#define SKG_PHANTOM_CONTACTS_H

#include "core/core.h"
#include "mesh/mesh.h"

/* Triangles in the cells of a grid, and whether triangles meet. */

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

/* Surfaces that fold over themselves. */

/* Finds the facets of a closed surface that meet facets other than their neighbours. *count: how many. fold: 1 or 0
 * per triangle. moved: only facets with a vertex marked here are tested; NULL: all. */
skg_status skg_shape_folds(const skg_mesh_arrays *arrays, const char *moved, int64_t *count, char *fold);

/* Smooths a surface where it folds over itself, until it does not, in at most 60 passes. */
skg_status skg_shape_unfold(const char *name, const skg_mesh_arrays *arrays);

/* Keeping surfaces apart. The regions that shape the organs keep gaps where they are sampled. Between the samples a
 * facet may still cut into a neighbour; it then draws back. */

/* Draws a surface back, along its normals, where it meets `count` other meshes or comes nearer to them than 0.2 mm,
 * until it does not; at most 15 mm. */
skg_status skg_shape_retreat(const char *name, int64_t count, skg_mesh *const *others,
                             skg_mesh_arrays *arrays);

#endif
