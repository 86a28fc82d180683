/* Priority resolution: which part an interval of a ray belongs to if parts overlap, and children that are clipped
 * to their parents. Private.
 *
 * Of the closed parts of one parent (or of the world) that contain a point, those of the highest priority count
 * there; parts of the same priority add. With clipping, a part counts only inside its closed parent. A part that
 * does not count ("falls") takes along every part inside it, at any depth. Closed parts inside a volume of cells are listed with it, since
 * its cells do not count where they are. Leaky parts neither displace nor are
 * displaced. The parts that may compete follow from the bounds of each frame, so that parts may move. */
#ifndef SKG_PRIORITY_H
#define SKG_PRIORITY_H

#include "geometry/bounds.h"
#include "geometry/overlaps.h"
#include "scene/scene.h"

/* Rules besides priorities. CLIP: children count only inside their parents; UNITE: of closed parts counts the union of what they enclose,
 * where the winding number is above 0. */
enum { SKG_RULE_CLIP = 1, SKG_RULE_UNITE = 2 };

static inline int32_t skg_priority_rules(int32_t clip, int32_t unite) {
    return (clip ? SKG_RULE_CLIP : 0) | (unite ? SKG_RULE_UNITE : 0);
}

typedef struct {
    int64_t count; /* of parts that compete, or fall with a part that does */
    /* Of these, background parts: they win over none, and are not clipped. Their hits matter only where a winner is. */
    int64_t background;
    int64_t *parts; /* [count] numbers of the parts, parents before children */
    /* Pixels where parts may compete: rows from, to, columns from, to. The whole detector if children are clipped. */
    int32_t window[4];
} skg_priority;

/* Whether any parts of a scene can ever compete. */
int skg_priority_possible(const skg_scene *scene, int32_t rules);

/* The parts that compete for these extents [parts of the scene], and where. */
skg_status skg_priority_find(const skg_scene *scene, int32_t rules, const skg_camera *camera,
                             const skg_extent *extents, skg_priority *priority);
void skg_priority_release(skg_priority *priority);

/* The number of competitors that the kernels of hits.cl are compiled for, and the ints of one entry of their
 * table. */
int64_t skg_priority_slots(const skg_priority *priority);
int64_t skg_priority_entry(const skg_priority *priority);

/* Fills the tables of hits.cl.
 *
 * slots   [parts of the scene] the competitor that a part is, plus SKG_HITS_BACKGROUND if it wins over none; or -1
 * table   [competitors][entry] part, plus SKG_HITS_UNITED if it is united; slot of the parent that it is clipped to or -1, the set of slots that displace
 *         it, the set of slots of its ancestors */
void skg_priority_tables(const skg_scene *scene, int32_t rules, const skg_priority *priority, int32_t *slots,
                         int32_t *table);

/* Fills `runs` [competitors][3]: the triangles of the competitors, first of winners and clipped parts, then of background
 * parts: number of the first triangle, part, slot. triangles: of both. */
void skg_priority_runs(const skg_scene *scene, int32_t rules, const skg_priority *priority, int32_t *runs,
                       int64_t triangles[2]);

/* The slot of a volume among the competitors, or -1, and the set of the slots of parts inside it: [slots / 32]. */
int64_t skg_priority_displacing(const skg_scene *scene, const skg_priority *priority, int64_t volume,
                                int32_t *set);

/* Whether priority or clipping decides what is seen of an overlapping pair, so that no warning is due. */
int skg_priority_settles(const skg_scene *scene, int32_t rules, const skg_overlap_pair *pair);

#endif
