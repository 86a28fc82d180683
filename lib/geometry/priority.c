/* Priority resolution: which part an interval of a ray belongs to if parts overlap, and children that are clipped to their parents. */
#include "geometry/priority.h"

#include "skg_shared.h"

static int may_win(const skg_scene_part_data *part, const skg_scene_part_data *over) {
    return part->inside == over->inside && part->priority > over->priority && part->mesh->closed &&
           over->mesh->closed;
}

/* The volume whose cells a part displaces because it lies inside, or -1. Cells differ, so no difference of materials does it. */
static int64_t displaced_by(const skg_scene *scene, int64_t part) {
    const int64_t parent = scene->parts[part].inside;
    return parent >= 0 && scene->parts[parent].volume && scene->parts[part].mesh->closed ? parent : -1;
}

/* The parent that a part is clipped to, or -1. */
static int64_t clipped_to(const skg_scene *scene, int32_t rules, int64_t part) {
    const int64_t parent = scene->parts[part].inside;
    return rules & SKG_RULE_CLIP && parent >= 0 && scene->parts[part].mesh->closed &&
                   scene->parts[parent].mesh->closed
               ? parent
               : -1;
}

static int is_united(const skg_scene *scene, int32_t rules, int64_t part) {
    return rules & SKG_RULE_UNITE && scene->parts[part].mesh->closed;
}

int skg_priority_possible(const skg_scene *scene, int32_t rules) {
    for (int64_t p = 0; p < scene->count; p++) {
        if (is_united(scene, rules, p)) return 1;
        if (clipped_to(scene, rules, p) >= 0 || displaced_by(scene, p) >= 0) return 1;
        if (scene->parts[p].priority == 0) continue; /* if priorities differ, one is not 0 */
        for (int64_t q = 0; q < scene->count; q++)
            if (may_win(&scene->parts[p], &scene->parts[q]) || may_win(&scene->parts[q], &scene->parts[p]))
                return 1;
    }
    return 0;
}

int skg_priority_settles(const skg_scene *scene, int32_t rules, const skg_overlap_pair *pair) {
    if (pair->kind == SKG_OVERLAP_PROTRUDES) return clipped_to(scene, rules, pair->part) >= 0;
    return scene->parts[pair->part].priority != scene->parts[pair->other].priority;
}

/* Whether the bounds of two parts meet on the detector and along the rays. */
static int meet(const skg_extent *a, const skg_extent *b) {
    const skg_scale_part *p = &a->scale, *q = &b->scale;
    return a->on_detector && b->on_detector && p->low_column <= q->high_column &&
           q->low_column <= p->high_column && p->low_row <= q->high_row && q->low_row <= p->high_row &&
           p->low_depth <= q->high_depth && q->low_depth <= p->high_depth;
}

/* Whether a part is a background part, which wins over none. With clipping any part may make another fall, by its absence; united
 * parts are settled wherever they are. */
static int is_background(const skg_scene *scene, int32_t rules, int64_t part) {
    if (rules || displaced_by(scene, part) >= 0) return 0;
    for (int64_t q = 0; q < scene->count; q++)
        if (may_win(&scene->parts[part], &scene->parts[q])) return 0;
    return 1;
}

enum { LISTED = 1, MAY_FALL = 2 };

static int wins(const skg_scene *scene, const skg_extent *extents, int64_t part, int64_t over) {
    return may_win(&scene->parts[part], &scene->parts[over]) && meet(&extents[part], &extents[over]);
}

/* Widens the window by the pixels where two parts may meet. */
static void add_to_window(const skg_camera *camera, const skg_extent *a, const skg_extent *b,
                          int32_t window[4]) {
    int32_t p[4], q[4];
    skg_extent_pixels(camera, a, p);
    skg_extent_pixels(camera, b, q);
    for (int k = 0; k < 4; k += 2) {
        const int32_t from = p[k] > q[k] ? p[k] : q[k], to = p[k + 1] < q[k + 1] ? p[k + 1] : q[k + 1];
        window[k] = from < window[k] ? from : window[k];
        window[k + 1] = to > window[k + 1] ? to : window[k + 1];
    }
}

static void mark_rivals(const skg_scene *scene, int32_t rules, const skg_camera *camera,
                        const skg_extent *extents, int32_t *marks, int32_t window[4]) {
    const int32_t size[2] = {(int32_t)camera->rows, (int32_t)camera->columns};
    for (int k = 0; k < 2; k++) window[2 * k] = size[k], window[2 * k + 1] = 0;
    for (int64_t p = 0; p < scene->count; p++) {
        const int64_t parent = clipped_to(scene, rules, p), volume = displaced_by(scene, p);
        if (volume >= 0 && meet(&extents[p], &extents[volume])) {
            marks[p] |= LISTED;
            marks[volume] |= LISTED;
            add_to_window(camera, &extents[p], &extents[volume], window);
        }
        if (is_united(scene, rules, p) && extents[p].on_detector) {
            marks[p] |= LISTED;
            add_to_window(camera, &extents[p], &extents[p], window);
        }
        if (parent >= 0 && extents[p].on_detector) {
            marks[p] |= LISTED | MAY_FALL;
            marks[parent] |= LISTED;
            for (int k = 0; k < 2; k++) window[2 * k] = 0, window[2 * k + 1] = size[k];
        }
        for (int64_t q = 0; q < scene->count; q++)
            if (wins(scene, extents, p, q)) {
                marks[p] |= LISTED;
                marks[q] |= LISTED | MAY_FALL;
                add_to_window(camera, &extents[p], &extents[q], window);
            }
    }
    for (int k = 0; k < 2; k++) window[2 * k + 1] = window[2 * k + 1] < size[k] ? window[2 * k + 1] : size[k];
}

/* Whether a part may lie where its ancestor `up` falls: anywhere if that is clipped, otherwise where a part that wins over
 * it is. */
static int may_share(const skg_scene *scene, int32_t rules, const skg_extent *extents, int64_t part,
                     int64_t up) {
    if (clipped_to(scene, rules, up) >= 0) return extents[part].on_detector;
    for (int64_t q = 0; q < scene->count; q++)
        if (wins(scene, extents, q, up) && meet(&extents[q], &extents[part])) return 1;
    return 0;
}

/* The level of a part below the world. On the way up the part is marked if it may fall with one of its ancestors. */
static int64_t level_of(const skg_scene *scene, int32_t rules, const skg_extent *extents, int64_t part,
                        int32_t *marks) {
    int64_t level = 0;
    for (int64_t up = scene->parts[part].inside; up >= 0; up = scene->parts[up].inside) {
        level++;
        if (marks[up] & MAY_FALL && !(marks[part] & LISTED) && scene->parts[part].mesh->closed &&
            may_share(scene, rules, extents, part, up))
            marks[part] |= LISTED;
    }
    return level;
}

skg_status skg_priority_find(const skg_scene *scene, int32_t rules, const skg_camera *camera,
                             const skg_extent *extents, skg_priority *priority) {
    int32_t *marks = NULL;
    int64_t *levels = NULL, deepest = 0;
    skg_status status = SKG_OK;
    *priority = (skg_priority){0};
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *marks, "priorities", &marks));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *levels, "priorities", &levels));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *priority->parts, "priorities", &priority->parts));
    mark_rivals(scene, rules, camera, extents, marks, priority->window);
    for (int64_t p = 0; p < scene->count; p++) {
        levels[p] = level_of(scene, rules, extents, p, marks);
        deepest = levels[p] > deepest ? levels[p] : deepest;
    }
    for (int64_t level = 0; level <= deepest; level++)
        for (int64_t p = 0; p < scene->count; p++)
            if (levels[p] == level && marks[p] & LISTED) {
                priority->parts[priority->count++] = p;
                priority->background += is_background(scene, rules, p);
            }
cleanup:
    skg_free(&marks);
    skg_free(&levels);
    if (status != SKG_OK) skg_priority_release(priority);
    return status;
}

void skg_priority_release(skg_priority *priority) {
    skg_free(&priority->parts);
    priority->count = 0;
}

int64_t skg_priority_slots(const skg_priority *priority) {
    int64_t slots = 32;
    while (slots < priority->count) slots *= 2; /* each size is a program of its own */
    return slots;
}

int64_t skg_priority_entry(const skg_priority *priority) {
    return 2 + 2 * skg_priority_slots(priority) / 32;
}

static void add_to_set(int32_t *set, int64_t slot) {
    set[slot / 32] = (int32_t)((uint32_t)set[slot / 32] | (uint32_t)1 << slot % 32);
}

void skg_priority_tables(const skg_scene *scene, int32_t rules, const skg_priority *priority, int32_t *slots,
                         int32_t *table) {
    const int64_t size = skg_priority_entry(priority), words = skg_priority_slots(priority) / 32;
    for (int64_t p = 0; p < scene->count; p++) slots[p] = -1;
    for (int64_t s = 0; s < priority->count; s++) slots[priority->parts[s]] = (int32_t)s;
    for (int64_t s = 0; s < priority->count; s++) {
        const int64_t part = priority->parts[s], parent = clipped_to(scene, rules, part);
        int32_t *entry = table + s * size;
        for (int64_t k = 2; k < size; k++) entry[k] = 0;
        entry[0] = (int32_t)part + (is_united(scene, rules, part) ? SKG_HITS_UNITED : 0);
        entry[1] = parent >= 0 ? slots[parent] : -1;
        for (int64_t other = 0; other < priority->count; other++)
            if (may_win(&scene->parts[priority->parts[other]], &scene->parts[part]))
                add_to_set(entry + 2, other);
        for (int64_t up = scene->parts[part].inside; up >= 0; up = scene->parts[up].inside)
            if (slots[up] >= 0) add_to_set(entry + 2 + words, slots[up]);
    }
    for (int64_t s = 0; s < priority->count; s++)
        if (is_background(scene, rules, priority->parts[s])) slots[priority->parts[s]] += SKG_HITS_BACKGROUND;
}

void skg_priority_runs(const skg_scene *scene, int32_t rules, const skg_priority *priority, int32_t *runs,
                       int64_t triangles[2]) {
    for (int background = 0; background < 2; background++) {
        triangles[background] = 0;
        for (int64_t s = 0; s < priority->count; s++) {
            const int64_t part = priority->parts[s];
            if (is_background(scene, rules, part) != background) continue;
            *runs++ = (int32_t)(background ? triangles[0] + triangles[1] : triangles[0]);
            *runs++ = (int32_t)part;
            *runs++ = (int32_t)s;
            triangles[background] += scene->parts[part].mesh->triangles;
        }
    }
}

int64_t skg_priority_displacing(const skg_scene *scene, const skg_priority *priority, int64_t volume,
                                int32_t *set) {
    int64_t slot = -1;
    for (int64_t w = 0; w < skg_priority_slots(priority) / 32; w++) set[w] = 0;
    for (int64_t s = 0; s < priority->count; s++) {
        if (priority->parts[s] == volume) slot = s;
        if (displaced_by(scene, priority->parts[s]) == volume) add_to_set(set, s);
    }
    return slot;
}
