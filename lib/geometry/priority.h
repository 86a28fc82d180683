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
} skg_contest;

/* Whether anything of a scene can ever compete. */
int skg_contest_possible(const skg_scene *scene, int32_t clip);

/* Who competes where parts lie as the extents say. */
skg_status skg_contest_find(const skg_scene *scene, int32_t clip, const skg_extent *extents,
                            skg_contest *contest);
void skg_contest_release(skg_contest *contest);

/* Ints of an entry of the kernels' table (hits.cl) for this many competitors, and how many those kernels are
 * made for. */
int64_t skg_contest_slots(const skg_contest *contest);
int64_t skg_contest_entry(const skg_contest *contest);

/* slots: [parts of the scene]; table: [competitors][entry]. */
void skg_contest_tables(const skg_scene *scene, int32_t clip, const skg_contest *contest, int32_t *slots,
                        int32_t *table);

/* Whether priority or clipping decides what an overlapping pair shows. */
int skg_contest_settles(const skg_scene *scene, int32_t clip, const skg_overlap_pair *pair);

#endif
