/* A tree of boxes over triangles, and the nearest of them to a point. */
#include "distance/nearest.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* LEAF: triangles of a leaf at most; a choice. DEEPEST: halves of 2^31 triangles, and one more. */
enum { LEAF = 4, DEEPEST = 33 };

typedef struct {
    skg_tree *tree;
    const double *positions;
    const int32_t *corners;
    double *centre; /* per triangle: three times the centre */
} builder;

static void add_bounds(const builder *b, int64_t triangle, double *bounds) {
    for (int c = 0; c < 3; c++) {
        const double *p = b->positions + 3 * (int64_t)b->corners[3 * triangle + c];
        for (int k = 0; k < 3; k++)
            bounds[k] = fmin(bounds[k], p[k]), bounds[3 + k] = fmax(bounds[3 + k], p[k]);
    }
}

/* Whether one triangle comes before another along an axis; their numbers decide between equal ones. */
static int before(const builder *b, int axis, int64_t one, int64_t other) {
    const double x = b->centre[3 * one + axis], y = b->centre[3 * other + axis];
    return x < y || (x == y && one < other);
}

/* Puts the triangles first..last-1 such that those before `middle` come before those from it on (Hoare). */
static void divide(const builder *b, int axis, int64_t first, int64_t last, int64_t middle) {
    int64_t *order = b->tree->order;
    for (last--; first < last;) {
        const int64_t pivot = order[first + (last - first) / 2];
        int64_t i = first, j = last;
        while (i <= j) {
            while (before(b, axis, order[i], pivot)) i++;
            while (before(b, axis, pivot, order[j])) j--;
            if (i > j) break;
            const int64_t swapped = order[i];
            order[i++] = order[j], order[j--] = swapped;
        }
        if (middle <= j)
            last = j;
        else if (middle >= i)
            first = i;
        else
            return;
    }
}

/* Adds the node of the triangles first..first+count-1 and those below it. */
static void add_node(const builder *b, int64_t first, int64_t count) {
    skg_tree *t = b->tree;
    const int64_t node = t->nodes++;
    double *bounds = t->bounds + 6 * node, low[3], high[3];
    for (int k = 0; k < 3; k++) bounds[k] = low[k] = HUGE_VAL, bounds[3 + k] = high[k] = -HUGE_VAL;
    for (int64_t i = first; i < first + count; i++) {
        const double *centre = b->centre + 3 * t->order[i];
        add_bounds(b, t->order[i], bounds);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], centre[k]), high[k] = fmax(high[k], centre[k]);
    }
    t->first[node] = first;
    t->count[node] = count;
    if (count <= LEAF) return;
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    divide(b, axis, first, first + count, first + count / 2);
    add_node(b, first, count / 2);
    t->count[node] = -t->nodes;
    add_node(b, first + count / 2, count - count / 2);
}

static skg_status build(builder *b, const char *name) {
    skg_tree *t = b->tree;
    const int64_t nodes = t->triangles + 1; /* a leaf has two triangles or more, unless it is the root */
    SKG_TRY(skg_alloc(6 * nodes, sizeof *t->bounds, name, &t->bounds));
    SKG_TRY(skg_alloc(nodes, sizeof *t->first, name, &t->first));
    SKG_TRY(skg_alloc(nodes, sizeof *t->count, name, &t->count));
    SKG_TRY(skg_alloc(t->triangles, sizeof *t->order, name, &t->order));
    SKG_TRY(skg_alloc(9 * t->triangles, sizeof *t->corners, name, &t->corners));
    SKG_TRY(skg_alloc(3 * t->triangles, sizeof *b->centre, name, &b->centre));
    for (int64_t i = 0; i < t->triangles; i++) {
        t->order[i] = i;
        for (int k = 0; k < 9; k++)
            b->centre[3 * i + k % 3] += b->positions[3 * (int64_t)b->corners[3 * i + k / 3] + k % 3];
    }
    add_node(b, 0, t->triangles);
    for (int64_t i = 0; i < t->triangles; i++)
        for (int c = 0; c < 3; c++)
            memcpy(t->corners + 9 * i + 3 * c, b->positions + 3 * (int64_t)b->corners[3 * t->order[i] + c],
                   3 * sizeof(double));
    return SKG_OK;
}

skg_status skg_tree_create(const char *name, const double *positions, int64_t triangles,
                           const int32_t *corners, skg_tree *tree) {
    builder b = {.tree = tree, .positions = positions, .corners = corners};
    *tree = (skg_tree){.triangles = triangles};
    const skg_status status = build(&b, name);
    skg_free(&b.centre);
    if (status != SKG_OK) skg_tree_free(tree);
    return status;
}

void skg_tree_free(skg_tree *tree) {
    void *block[] = {&tree->bounds, &tree->first, &tree->count, &tree->order, &tree->corners};
    for (size_t i = 0; i < sizeof block / sizeof *block; i++) skg_free(block[i]);
}

/* Square of the distance from a point to a box. */
static double box_distance(const double *bounds, const double p[3]) {
    double away = 0;
    for (int k = 0; k < 3; k++) {
        const double d = p[k] < bounds[k]       ? bounds[k] - p[k]
                         : p[k] > bounds[3 + k] ? p[k] - bounds[3 + k]
                                                : 0;
        away += d * d;
    }
    return away;
}

static double triangle_distance(const double *corners, const double p[3]) {
    double w[3], d[3];
    skg_triangle_nearest(corners, corners + 3, corners + 6, p, w);
    for (int k = 0; k < 3; k++)
        d[k] = w[0] * corners[k] + w[1] * corners[3 + k] + w[2] * corners[6 + k] - p[k];
    return skg_dot(d, d);
}

static void search_leaf(const skg_tree *t, int64_t node, const double p[3], double *least, int64_t *found) {
    for (int64_t i = t->first[node]; i < t->first[node] + t->count[node]; i++) {
        const double square = triangle_distance(t->corners + 9 * i, p);
        if (square > *least || (square == *least && *found >= 0 && t->order[i] > *found)) continue;
        *least = square, *found = t->order[i];
    }
}

double skg_tree_nearest(const skg_tree *t, const double p[3], double within, int64_t *triangle) {
    int64_t waiting[DEEPEST], found = -1;
    double away[DEEPEST], least = within;
    int depth = 0;
    waiting[0] = 0, away[0] = box_distance(t->bounds, p), depth = 1;
    while (depth-- > 0) {
        const int64_t node = waiting[depth];
        if (away[depth] > least) continue;
        if (t->count[node] > 0) {
            search_leaf(t, node, p, &least, &found);
            continue;
        }
        const int64_t left = node + 1, right = -t->count[node];
        const double to_left = box_distance(t->bounds + 6 * left, p);
        const double to_right = box_distance(t->bounds + 6 * right, p);
        const int left_first = to_left <= to_right;
        waiting[depth] = left_first ? right : left, away[depth++] = left_first ? to_right : to_left;
        waiting[depth] = left_first ? left : right, away[depth++] = left_first ? to_left : to_right;
    }
    if (triangle) *triangle = found;
    return least;
}
