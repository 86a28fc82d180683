/* Parts that overlap, and parts that leave their parent. Private.
 *
 * The lengths of overlapping siblings are added, and a child outside its parent subtracts the parent. Nothing is
 * clamped, so both cases are found and reported.
 *
 * Method: a grid of parallel columns covers the scene. Along each column, the signed hits of all closed parts
 * are sorted and swept. Volumes are sums over columns and therefore have the resolution of the grid. */
#ifndef SKG_OVERLAP_H
#define SKG_OVERLAP_H

#include "geometry/columns.h"

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

#endif
