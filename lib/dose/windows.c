/* Volumes that priorities, clip and unite leave parts, and cells that others displace: by lines through the boxes where that can be.
 * Outside of them volumes are exact, and a box of its own resolves a thin part. */
#include "dose/figures.h"

#include "core/maths.h"
#include "core/threads.h"
#include "scene/scene.h"

#include <stdlib.h>

/* --- where */

typedef struct {
    const skg_rules *rules;
    skg_dose_window *of; /* [parts] boxes of the parts; empty of leaky ones */
    skg_dose_window *windows;
    int64_t count, room;
} window_list;

static void bound_parts(const skg_forest *tree, int64_t parts, skg_dose_window *of) {
    for (int64_t p = 0; p < parts; p++)
        for (int k = 0; k < 3; k++) of[p].low[k] = HUGE_VAL, of[p].high[k] = -HUGE_VAL;
    for (int64_t t = 0; t < tree->count; t++)
        for (int k = 0; k < 9; k++) {
            skg_dose_window *box = &of[tree->part[t]];
            box->low[k % 3] = fmin(box->low[k % 3], tree->corners[t][k]);
            box->high[k % 3] = fmax(box->high[k % 3], tree->corners[t][k]);
        }
}

/* The box that two have in common. Returns 0 if there is none. */
static int intersect(const skg_dose_window *a, const skg_dose_window *b, skg_dose_window *both) {
    int meet = 1;
    for (int k = 0; k < 3; k++) {
        both->low[k] = fmax(a->low[k], b->low[k]), both->high[k] = fmin(a->high[k], b->high[k]);
        meet &= both->low[k] < both->high[k];
    }
    return meet;
}

static skg_status add_window(window_list *list, int64_t part, int64_t other) {
    skg_dose_window both;
    if (!intersect(&list->of[part], &list->of[other], &both)) return SKG_OK;
    if (list->count == list->room) {
        const int64_t room = 2 * list->room + 64;
        SKG_TRY(skg_realloc(room, sizeof *list->windows, "dose", &list->windows));
        list->room = room;
    }
    list->windows[list->count++] = both;
    return SKG_OK;
}

/* Whether a part, or one that it lies inside, is displaced by another that has the same parent as that. */
static int may_fall(const skg_scene *scene, int64_t part, int64_t winner) {
    for (int64_t up = part; up >= 0; up = scene->parts[up].inside)
        if (up != winner && scene->parts[up].inside == scene->parts[winner].inside &&
            scene->parts[winner].priority > scene->parts[up].priority)
            return 1;
    return 0;
}

static skg_status list_windows(window_list *list) {
    const skg_rules *rules = list->rules;
    const skg_scene *scene = rules->scene;
    for (int64_t p = 0; p < scene->count; p++) {
        const int64_t parent = scene->parts[p].inside;
        if ((rules->clip && parent >= 0) || rules->unite) SKG_TRY(add_window(list, p, p));
        if (parent >= 0 && scene->parts[parent].volume) SKG_TRY(add_window(list, p, parent));
        for (int64_t q = 0; rules->competing && q < scene->count; q++)
            if (may_fall(scene, p, q)) SKG_TRY(add_window(list, p, q));
    }
    return SKG_OK;
}

static double thinnest(const skg_dose_window *w) {
    return fmin(fmin(w->high[0] - w->low[0], w->high[1] - w->low[1]), w->high[2] - w->low[2]);
}

static int by_thickness(const void *a, const void *b) {
    const double x = thinnest(a), y = thinnest(b);
    return x < y ? -1 : x > y;
}

skg_status skg_dose_windows_find(const skg_rules *rules, const skg_forest *tree, int64_t *count,
                                 skg_dose_window **windows) {
    window_list list = {.rules = rules};
    *count = 0;
    *windows = NULL;
    SKG_TRY(skg_alloc(rules->scene->count, sizeof *list.of, "dose", &list.of));
    bound_parts(tree, rules->scene->count, list.of);
    const skg_status status = list_windows(&list);
    skg_free(&list.of);
    if (list.count > 1) qsort(list.windows, (size_t)list.count, sizeof *list.windows, by_thickness);
    *count = list.count;
    *windows = list.windows;
    return status;
}

/* --- what the rules make of the volumes there */

/* Lines along each side of a box: all boxes together have about LINES^2, but each LEAST^2 at least. */
enum { LINES = 384, LEAST = 32 };

/* The rows of lines of one box. */
typedef struct {
    const skg_rules *rules;
    const skg_forest *tree;
    const skg_dose_window *windows; /* those before number `window` are done */
    int64_t window, lines;
    double *sums; /* [lines][parts] */
} row_work;

/* The stretches of a line along z that are to be counted, in mm from its beginning. */
typedef struct {
    int64_t count, room;
    double (*of)[2];
} stretches;

static skg_status add_stretch(stretches *s, double from, double to) {
    if (!(to > from)) return SKG_OK;
    if (s->count == s->room) {
        SKG_TRY(skg_realloc(2 * s->room + 16, sizeof *s->of, "dose", &s->of));
        s->room = 2 * s->room + 16;
    }
    s->of[s->count][0] = from, s->of[s->count++][1] = to;
    return SKG_OK;
}

/* A line's way through the box, less the boxes that are done. */
static skg_status find_stretches(const row_work *w, const double from[3], stretches *s) {
    const skg_dose_window *own = &w->windows[w->window];
    s->count = 0;
    SKG_TRY(add_stretch(s, own->low[2] - from[2], own->high[2] - from[2]));
    for (int64_t b = 0; b < w->window && s->count > 0; b++) {
        const skg_dose_window *done = &w->windows[b];
        if (from[0] < done->low[0] || from[0] >= done->high[0] || from[1] < done->low[1] ||
            from[1] >= done->high[1])
            continue;
        const int64_t count = s->count;
        for (int64_t i = 0; i < count; i++) {
            const double low = s->of[i][0], high = s->of[i][1];
            s->of[i][1] = fmin(high, done->low[2] - from[2]);
            SKG_TRY(add_stretch(s, fmax(low, done->high[2] - from[2]), high));
        }
        for (int64_t i = s->count - 1; i >= 0; i--)
            if (!(s->of[i][1] > s->of[i][0])) {
                s->count--;
                s->of[i][0] = s->of[s->count][0], s->of[i][1] = s->of[s->count][1];
            }
    }
    return SKG_OK;
}

static double counted_between(const stretches *s, double from, double to) {
    double sum = 0;
    for (int64_t i = 0; i < s->count; i++) sum += fmax(0, fmin(to, s->of[i][1]) - fmax(from, s->of[i][0]));
    return sum;
}

/* Adds the shares that the rules give. area: mm2 of a line, or less than 0 to take them off; only: the part that counts, or -1: all. */
static void add_shares(const skg_way *way, const stretches *s, double area, int64_t only, double *sums) {
    for (int64_t i = 0; i < way->piece_count; i++) {
        const skg_piece *piece = &way->pieces[i];
        const double mm = counted_between(s, piece->from, piece->to);
        for (int64_t k = piece->first; mm > 0 && k < piece->first + piece->count; k++) {
            const skg_presence *at = &way->presences[k];
            if (at->part >= 0 && (only < 0 || at->part == only)) sums[at->part] += at->share * mm * area;
        }
    }
}

/* Takes off what by_surfaces of volumes.c has counted: windings, less those of the parts inside. */
static void take_off_surfaces(const skg_scene *scene, const skg_way *way, const stretches *s, double area,
                              double *sums) {
    for (int64_t i = 0; i < way->crossing_count; i++) {
        const skg_crossing *c = &way->crossings[i];
        const double mm3 = c->sign * counted_between(s, c->at, HUGE_VAL) * area;
        const int64_t parent = scene->parts[c->part].inside;
        if (!scene->parts[c->part].volume) sums[c->part] -= mm3;
        if (parent >= 0 && !scene->parts[parent].volume) sums[parent] += mm3;
    }
}

/* Takes off what volumes of cells would weigh alone, where they are met. */
static skg_status take_off_cells(const row_work *w, const double from[3], double reach, const stretches *s,
                                 double area, skg_way *way, double *sums) {
    const double along[3] = {0, 0, 1};
    const skg_scene *scene = w->rules->scene;
    for (int64_t p = 0; w->rules->cells && p < scene->count; p++) {
        const skg_rules alone = {.scene = scene, .cells = 1, .alone = (int32_t)p + 1};
        if (!scene->parts[p].volume) continue;
        SKG_TRY(skg_way_find_cells(w->tree, &alone, from, along, reach, way));
        add_shares(way, s, -area, p, sums);
    }
    return SKG_OK;
}

static skg_status add_line(const row_work *w, const double from[3], double reach, double area, stretches *s,
                           skg_way *way, double *sums) {
    const double along[3] = {0, 0, 1};
    SKG_TRY(find_stretches(w, from, s));
    if (s->count == 0) return SKG_OK;
    SKG_TRY(skg_way_find_cells(w->tree, w->rules, from, along, reach, way));
    add_shares(way, s, area, -1, sums);
    take_off_surfaces(w->rules->scene, way, s, area, sums);
    return take_off_cells(w, from, reach, s, area, way, sums);
}

static skg_status add_row(void *user, int64_t row) {
    const row_work *w = user;
    const skg_forest_node *all = &w->tree->nodes[0];
    const skg_dose_window *box = &w->windows[w->window];
    const double reach = 2 * (all->high[2] - all->low[2]) + 2, lines = (double)w->lines;
    const double step[2] = {(box->high[0] - box->low[0]) / lines, (box->high[1] - box->low[1]) / lines};
    skg_way way = {0};
    stretches s = {0};
    skg_status status = SKG_OK;
    for (int64_t i = 0; i < w->lines && status == SKG_OK; i++) {
        /* Off the middles, so that faces along the axes are rarely met exactly. */
        const double from[3] = {box->low[0] + ((double)i + 0.4142135623730951) * step[0],
                                box->low[1] + ((double)row + 0.7320508075688772) * step[1], all->low[2] - 1};
        status =
            add_line(w, from, reach, step[0] * step[1], &s, &way, w->sums + row * w->rules->scene->count);
    }
    skg_way_free(&way);
    skg_free(&s.of);
    return status;
}

/* The sums of all rows, and how far those of every second row are from those of the others. */
static void add_rows(const row_work *w, double *volumes, double *errors) {
    const int64_t parts = w->rules->scene->count;
    for (int64_t p = 0; p < parts; p++) {
        double of[2] = {0, 0};
        for (int64_t row = 0; row < w->lines; row++) of[row % 2] += w->sums[row * parts + p];
        volumes[p] += of[0] + of[1];
        errors[p] += 0.25 * (of[0] - of[1]) * (of[0] - of[1]);
    }
}

skg_status skg_dose_windows_add(const skg_rules *rules, const skg_forest *tree, int64_t count,
                                const skg_dose_window *windows, skg_progress *progress, double *volumes,
                                double *errors) {
    const int64_t each = count > 0 ? (int64_t)(LINES / sqrt((double)count)) / 2 * 2 : 0;
    row_work w = {.rules = rules, .tree = tree, .windows = windows, .lines = each > LEAST ? each : LEAST};
    const int64_t room = w.lines * rules->scene->count;
    skg_status status = SKG_OK;
    if (count == 0) return SKG_OK;
    SKG_TRY(skg_alloc(room, sizeof *w.sums, "dose", &w.sums));
    for (; w.window < count && status == SKG_OK; w.window++) {
        for (int64_t i = 0; i < room; i++) w.sums[i] = 0;
        status = skg_progress_step(progress, 0, 1);
        if (status == SKG_OK) status = skg_parallel(w.lines, add_row, &w);
        if (status == SKG_OK) add_rows(&w, volumes, errors);
    }
    skg_free(&w.sums);
    return status;
}
