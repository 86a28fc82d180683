/* A grid of columns along z through closed surfaces, with the signed hits along each. Private. */
#ifndef SKG_COLUMNS_H
#define SKG_COLUMNS_H

#include "core/core.h"

/* A closed surface (mm): a part in world coordinates, or a component of a mesh. */
typedef struct {
    int64_t vertices, triangles;
    const double *positions; /* [vertices][3] */
    const int32_t *corners;  /* [triangles][3] */
    int64_t inside;          /* the parent's number, or -1 */
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

#endif
