/* Columns through solids; which parts overlap or lie in each other. Private. */
#ifndef SKG_OVERLAPS_H
#define SKG_OVERLAPS_H

#include "core/core.h"
#include "mesh/mesh.h"

#include <skiagraph/mesh.h>

/* --- A grid of columns along z through closed surfaces, with the signed hits along each. */

/* A closed surface (mm): a part in world coordinates, or a component of a mesh. */
typedef struct {
    int64_t vertices, triangles;
    const double *positions; /* [vertices][3] */
    const int32_t *corners;  /* [triangles][3] */
    int64_t inside;          /* the parent's number, or -1 */
    int32_t inward;          /* 1: its triangles face inward, as those of a mirrored part */
    int32_t reserved;
} skg_solid;

typedef struct {
    double depth;       /* mm, along z */
    int32_t part, sign; /* the solid's number; 1: the column enters it, -1: it leaves */
} skg_column_hit;

typedef struct {
    int64_t side;            /* columns along x and along y, at most 65,535; set by the caller */
    int64_t first_row, rows; /* along y, those that are gathered; set by the caller */
    double low[3], high[3], step[2];
    int64_t *first; /* [rows * side + 1] hits of each column */
    skg_column_hit *hits;
} skg_columns;

/* The rows that meet a triangle: first <= row < end. */
typedef struct {
    uint16_t first, end;
} skg_column_rows;

/* Sets the bounds to those of the solids. The grid is empty where a step is not above 0. */
void skg_columns_bound(skg_columns *grid, int64_t count, const skg_solid *solids);

/* How many hits the columns of the whole grid will have, from the areas of the triangles across z. */
double skg_columns_hits_estimate(const skg_columns *grid, int64_t count, const skg_solid *solids);

/* Finds the rows of the whole grid that meet each triangle, numbered through all solids, by several threads. The caller
 * frees *rows. */
skg_status skg_columns_span(const skg_columns *grid, int64_t count, const skg_solid *solids,
                            skg_column_rows **rows);

/* Finds the hits of each column: those of cell (row - first_row) * side + column are hits[first[cell]] to
 * hits[first[cell + 1] - 1], in no order. rows: of skg_columns_span, which spares other triangles a look; may be NULL. Free
 * the columns also after a failure. */
skg_status skg_columns_gather(skg_columns *grid, int64_t count, const skg_solid *solids,
                              const skg_column_rows *rows);
void skg_columns_free(skg_columns *grid);

/* Sorts the hits of a cell by depth. */
void skg_columns_sort(skg_columns *grid, int64_t cell);

/* Where column `index` of an axis (0: x, 1: y) is, mm. */
double skg_column_place(const skg_columns *grid, int axis, int64_t index);

/* --- Parts as closed surfaces in world coordinates. */

/* Places a mesh. A leaky one gives a solid without triangles.
 *
 * inside      the parent's number, or -1
 * positions   result: [vertices][3] the caller frees it after the solid's last use; NULL of a leaky mesh */
skg_status skg_solid_place(const skg_mesh *mesh, const double pose[16], int64_t inside, skg_solid *solid,
                           double **positions);

/* --- Parts that overlap, and parts that leave their parent. *
 * The lengths of overlapping siblings are added, and a child outside its parent subtracts the parent. Nothing is
 * clamped, so both cases are found and reported.
 *
 * Method: a grid of parallel columns covers the scene. Along each column, the signed hits of all closed parts
 * are sorted and swept. Volumes are sums over columns and therefore have the resolution of the grid. */

enum { SKG_OVERLAP_SIBLINGS = 0, SKG_OVERLAP_PROTRUDES = 1 };

typedef struct {
    int32_t kind;
    int64_t part, other; /* siblings: part < other; protrudes: `part` leaves its parent `other` */
    double volume;       /* mm3 */
    double longest;      /* mm, the longest chord along a column */
    double place[3];     /* mm, the middle of that chord */
} skg_overlap_pair;

/* The columns along each side of the grid, unless they have more than 10^7 hits. */
enum { SKG_OVERLAP_SIDE = 256 };

/* Finds every pair; the largest volume comes first. The caller frees *pairs with skg_free. A solid without triangles
 * takes no part: leaky parts are passed so. *side: the columns along each side that were taken. */
skg_status skg_overlaps_find(int64_t count, const skg_solid *solids, int64_t *side, int64_t *pair_count,
                             skg_overlap_pair **pairs);

/* --- How the components of a mesh lie in each other. */

/* As skg_mesh_nesting_get, and which triangles a turn concerns.
 *
 * turned   [triangles] 1: of an inverted component; may be NULL */
skg_status skg_nesting_find(const skg_mesh *mesh, skg_mesh_nesting *nesting, unsigned char *turned);

#endif
