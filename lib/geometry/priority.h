/* Which part has an interval of a ray to itself: priorities of overlapping parts, and children clipped to
 * their parents. Private.
 *
 * Of the closed parts with one parent (or in the world) that a point lies in, those of the highest priority
 * count; parts of the same priority add. With clipping a part counts only where its closed parent is. What
 * falls takes along what lies inside it, at any depth. Open parts neither win nor lose. Who may compete
 * follows from each frame's bounds, so that parts may move. */
#ifndef SKG_PRIORITY_H
#define SKG_PRIORITY_H

#include "geometry/extent.h"
#include "geometry/overlap.h"
#include "scene/scene.h"

typedef struct {
    int64_t count;  /* of parts that compete, or fall with one that does */
    int64_t *parts; /* [count] their numbers, parents before children */
} skg_priority;

/* Whether anything of a scene can ever compete. */
int skg_priority_possible(const skg_scene *scene, int32_t clip);

/* Who competes where parts lie as the extents say. */
skg_status skg_priority_find(const skg_scene *scene, int32_t clip, const skg_extent *extents,
                             skg_priority *priority);
void skg_priority_release(skg_priority *priority);

/* Ints of an entry of the kernels' table (hits.cl) for this many competitors, and how many those kernels are
 * made for. */
int64_t skg_priority_slots(const skg_priority *priority);
int64_t skg_priority_entry(const skg_priority *priority);

/* slots: [parts of the scene]; table: [competitors][entry]. */
void skg_priority_tables(const skg_scene *scene, int32_t clip, const skg_priority *priority, int32_t *slots,
                         int32_t *table);

/* Whether priority or clipping decides what an overlapping pair shows. */
int skg_priority_settles(const skg_scene *scene, int32_t clip, const skg_overlap_pair *pair);

#endif
