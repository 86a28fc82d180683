/* A generated thorax that breathes. */
#ifndef SKG_BREATHER_H
#define SKG_BREATHER_H

#include "body/types.h"

#include <skiagraph/skiagraph.h>

typedef struct {
    skg_thorax *thorax;
    skg_body *body;
} breather;

/* options: NULL for the defaults. */
void breather_make(breather *b, int64_t triangles, int simple, const skg_body_options *options);
void breather_drop(breather *b);

/* Poses it with two weights, and measures. */
skg_body_measure breather_pose(breather *b, double thoracic, double diaphragmatic);

/* Every named breath at that many phases: no link broken, no facet folded, at most conflict_mm of conflict, and the liver
 * keeps its volume to 1 %. */
void breather_check(breather *b, int phases, double conflict_mm);

#endif
