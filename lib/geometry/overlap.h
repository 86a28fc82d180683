/* Which parts overlap, and which leave their parent. Private.
 *
 * Lengths of overlapping siblings add and a child outside its parent subtracts the parent: nothing is
 * clamped, so both are found and told. Method: a grid of parallel columns over the scene; along each, the
 * signed hits of all closed parts are sorted and swept. Volumes are sums over columns, so they carry the
 * grid's resolution. */
#ifndef SKG_OVERLAP_H
#define SKG_OVERLAP_H

#include "core/core.h"

/* A closed part as the sweep needs it, in world coordinates (mm). */
typedef struct {
    int64_t vertices, triangles;
    const double *positions; /* [vertices][3] */
    const int32_t *corners;  /* [triangles][3] */
    int64_t inside;          /* the parent's number, or -1 */
} skg_solid;

enum { SKG_OVERLAP_SIBLINGS = 0, SKG_OVERLAP_PROTRUDES = 1 };

typedef struct {
    int32_t kind;
    int64_t part, other; /* siblings: part < other; protrudes: part leaves its parent `other` */
    double volume;       /* mm3 */
    double longest;      /* mm, longest chord along the columns */
    double place[3];     /* mm, the middle of that chord */
} skg_overlap_pair;

/* Finds every pair, worst volume first; *pairs is freed by the caller with skg_free. Solids without triangles
 * (open parts, left out) are allowed. */
skg_status skg_overlaps_find(int64_t count, const skg_solid *solids, int64_t *pair_count,
                             skg_overlap_pair **pairs);

#endif
