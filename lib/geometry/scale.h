/* The scale of an integer plane: the number of units for a weighted path parameter of 1. Private.
 *
 * Sums are exact integers and must not wrap. The scale is the largest power of two with bound * scale < 2^30,
 * where `bound` is the largest sum that any pixel may have: the maximum over coarse cells of the detector of the
 * sums that all parts whose projected rectangles meet the cell can add. It follows from the bounds of one frame
 * alone, so that earlier frames change no bit. */
#ifndef SKG_SCALE_H
#define SKG_SCALE_H

#include "core/core.h"

/* The side of a coarse cell in pixels. */
enum { SKG_SCALE_CELL = 32 };

/* The most that one part can add to a plane, and where. */
typedef struct {
    double low_column, high_column, low_row,
        high_row;                 /* projected rectangle in pixels; may leave the detector */
    double low_depth, high_depth; /* path parameter, from and to */
    double weight;                /* largest |weight| */
    double multiplicity;          /* layers of the part that may lie over each other, >= 1 */
} skg_scale_part;

typedef struct {
    int64_t columns, rows; /* of coarse cells */
    double *sums;          /* workspace: (columns + 1) * (rows + 1) */
} skg_scale_grid;

skg_status skg_scale_grid_create(int64_t columns, int64_t rows, skg_scale_grid *grid);

/* The part of a grid that a smaller detector takes. It borrows the memory. */
skg_scale_grid skg_scale_grid_of(const skg_scale_grid *grid, int64_t columns, int64_t rows);
void skg_scale_grid_release(skg_scale_grid *grid);

typedef struct {
    double bound; /* no pixel's sum exceeds it */
    /* The bound of a scene whose parts do not overlap: its whole depth at the largest weight. */
    double plausible;
    double scale; /* power of two; 1 if nothing is on the detector */
    int32_t bits; /* 32, or 64 if the last bit of 32 would exceed 2^-24 of `plausible` */
} skg_scale;

/* The scale for these parts; bits_wanted: 32 (64 where needed) or 64. */
void skg_scale_find(const skg_scale_grid *grid, int64_t count, const skg_scale_part *parts,
                    int32_t bits_wanted, skg_scale *scale);

#endif
