/* The scale of an integer plane: how many units a weighted path parameter of 1 is worth. Private.
 *
 * Sums are exact integers, so the scale must leave no pixel room to wrap: the largest power of two with
 * bound * scale < 2^30, where bound is the largest sum, over coarse cells of the detector, of what every part
 * whose projected rectangle meets the cell can add. It comes from one frame's bounds alone, never from
 * history. */
#ifndef SKG_SCALE_H
#define SKG_SCALE_H

#include "core/core.h"

/* Side of a coarse cell in pixels. */
enum { SKG_SCALE_CELL = 32 };

/* What one part can add to a plane, and where. */
typedef struct {
    double low_column, high_column, low_row,
        high_row;                 /* projected rectangle in pixels; may leave the detector */
    double low_depth, high_depth; /* path parameter, from and to */
    double weight;                /* largest |weight| */
    double multiplicity;          /* how many layers of the part may lie over each other, >= 1 */
} skg_scale_part;

typedef struct {
    int64_t columns, rows; /* of coarse cells */
    double *sums;          /* workspace: (columns + 1) * (rows + 1) */
} skg_scale_grid;

skg_status skg_scale_grid_create(int64_t columns, int64_t rows, skg_scale_grid *grid);
void skg_scale_grid_release(skg_scale_grid *grid);

typedef struct {
    double bound;     /* no pixel's sum exceeds it */
    double plausible; /* the sum if the parts did not overlap: the whole depth of the scene at the largest
                         weight */
    double scale;     /* power of two; 1 where nothing is on the detector */
    int32_t bits;     /* 32, or 64 where the last bit of 32 would exceed 2^-24 of what is plausible */
} skg_scale;

/* The scale for these parts; bits_wanted: 32 (64 where needed) or 64. */
void skg_scale_find(const skg_scale_grid *grid, int64_t count, const skg_scale_part *parts,
                    int32_t bits_wanted, skg_scale *scale);

#endif
