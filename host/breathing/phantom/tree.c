/* Surfaces of branching tubes. */
#include "phantom/shapes.h"

#include "core/maths.h"

#include <stdio.h>
#include <string.h>

/* Points of a branch's middle line, most branches of a lung, orders of branching, and candidates of one direction. */
enum { POINTS = 6, BRANCHES_MAX = 170, ORDERS = 3 };

static const double apart = 0.3;  /* mm between the walls of branches */
static const double shortest = 9; /* mm */

typedef struct {
    double point[POINTS][3], first, last; /* radii at the ends, mm */
    int order;
} branch;

typedef struct {
    skg_tree_room room;
    const void *shape;
    double side;
    uint32_t random;
    int count;
    branch branch[BRANCHES_MAX];
} tree;

/* Arteries and veins from the hilum of the left lung: where they begin, where they lead, their radius, mm. The first
 * is the artery of the lower lobe. */
static const struct {
    double from[3], by[3], to[3], radius;
} trunk[] = {
    {{50, -30, 64}, {62, -22, 36}, {70, 2, -26}, 8},     {{44, -38, 86}, {54, -42, 108}, {48, -40, 138}, 5.6},
    {{44, -48, 80}, {70, -72, 88}, {84, -98, 96}, 5.4},  {{44, -26, 80}, {72, -8, 98}, {84, 4, 116}, 5.2},
    {{46, -40, 72}, {78, -50, 70}, {106, -56, 62}, 5.2}, {{46, -52, 66}, {74, -74, 50}, {96, -96, 32}, 5.2},
    {{48, -38, 58}, {80, -48, 34}, {104, -58, 8}, 5.6},  {{55, -18, 62}, {59, 0, 56}, {66, 20, 46}, 4.4}};
enum { TRUNKS = sizeof trunk / sizeof *trunk };

/* A number from 0 to 1 (Numerical Recipes' linear congruences). */
static double random_of(tree *t) {
    t->random = 1664525u * t->random + 1013904223u;
    return (double)(t->random >> 8) / (double)(1u << 24);
}

static void unit(double *v) {
    skg_scale_vector(1 / skg_length(v), v, v);
}

static double radius_at(const branch *b, double t) {
    return b->first + t * (b->last - b->first);
}

static void point_of(const branch *b, double t, double p[3]) {
    const int i = t < 1 ? (int)(t * (POINTS - 1)) : POINTS - 2;
    const double w = t * (POINTS - 1) - i;
    for (int k = 0; k < 3; k++) p[k] = (1 - w) * b->point[i][k] + w * b->point[i + 1][k];
}

/* Whether a ball lies within the lung and clear of all branches. */
static int is_free(const tree *t, const double p[3], double radius) {
    const double mirrored[3] = {t->side * p[0], p[1], p[2]};
    if (!t->room(t->shape, mirrored, radius)) return 0;
    for (int b = 0; b < t->count; b++)
        for (int s = 0; s < POINTS - 1; s++) {
            const double *from = t->branch[b].point[s], *to = t->branch[b].point[s + 1];
            double d[3], q[3];
            skg_add_scaled(to, -1, from, d);
            skg_add_scaled(p, -1, from, q);
            const double w = fmin(fmax(skg_dot(q, d) / skg_dot(d, d), 0), 1);
            skg_add_scaled(q, -w, d, q);
            if (skg_length(q) < radius + apart + radius_at(t->branch + b, (s + w) / (POINTS - 1))) return 0;
        }
    return 1;
}

/* The first part of a branch that is free, as fractions of its length. A trunk may begin later than given. */
static void find_free(const tree *t, const branch *b, double length, double *from, double *to) {
    const int steps = 1 + (int)(length / 1.5); /* mm */
    *from = *to = 0;
    for (int s = 0; s <= steps; s++) {
        const double at = (double)s / steps;
        double p[3];
        point_of(b, at, p);
        const int is_clear = is_free(t, p, radius_at(b, at));
        if (!is_clear && (*to > 0 || b->order > 0)) return;
        if (is_clear)
            *to = at;
        else
            *from = (double)(s + 1) / steps;
    }
}

static double length_of(const branch *b) {
    double d[3], length = 0;
    for (int i = 0; i + 1 < POINTS; i++) {
        skg_add_scaled(b->point[i + 1], -1, b->point[i], d);
        length += skg_length(d);
    }
    return length;
}

/* Adds a branch as far as it is free. */
static void add(tree *t, const branch *given) {
    branch b = *given;
    const double whole = length_of(&b);
    double from, to;
    find_free(t, &b, whole, &from, &to);
    if ((to - from) * whole < shortest || t->count == BRANCHES_MAX) return;
    for (int i = 0; i < POINTS; i++)
        point_of(given, from + (double)i / (POINTS - 1) * (to - from), b.point[i]);
    t->branch[t->count++] = b;
}

/* Adds a trunk; where the heart or a great vessel leaves it too little room, farther to the side and to the back. */
static void add_trunk(tree *t, int n) {
    const double away[3] = {7, 5, 0}; /* mm */
    branch best = {0};
    double most = 0;
    for (int shift = 0; shift < 4; shift++) {
        branch b = {.first = trunk[n].radius, .last = 0.22 * trunk[n].radius};
        double from, to;
        for (int i = 0; i < POINTS; i++) {
            const double s = (double)i / (POINTS - 1), r = 1 - s;
            for (int k = 0; k < 3; k++)
                b.point[i][k] = r * r * trunk[n].from[k] + 2 * r * s * trunk[n].by[k] +
                                s * s * trunk[n].to[k] + shift * away[k];
        }
        find_free(t, &b, length_of(&b), &from, &to);
        if (to - from <= most + 0.15) continue;
        most = to - from, best = b;
    }
    if (most > 0) add(t, &best);
}

/* A branch from a place of its parent, at `azimuth` about it, that bends towards the parent's direction. */
static void add_side(tree *t, const branch *parent, double at, double azimuth, double length) {
    const double angle = 0.9; /* rad between parent and branch where it begins */
    double along[3], across[3], up[3] = {0, 0, 1}, from[3], before[3], way[3];
    branch b = {.order = parent->order + 1};
    point_of(parent, at, from);
    point_of(parent, at - 0.08, before);
    skg_add_scaled(from, -1, before, along);
    unit(along);
    if (fabs(along[2]) > 0.9) up[1] = 1, up[2] = 0;
    skg_cross(along, up, across);
    unit(across);
    skg_cross(along, across, up);
    for (int k = 0; k < 3; k++)
        way[k] = cos(angle) * along[k] + sin(angle) * (cos(azimuth) * across[k] + sin(azimuth) * up[k]);
    const double thick = radius_at(parent, at);
    b.first = fmin(0.9 * thick, 4.4), b.last = fmax(0.45 * b.first, 0.7);
    skg_add_scaled(from, (thick + b.first + 3 * apart) / sin(angle), way, b.point[0]);
    for (int i = 1; i < POINTS; i++) {
        skg_add_scaled(way, 0.12, along, way);
        unit(way);
        skg_add_scaled(b.point[i - 1], length / (POINTS - 1), way, b.point[i]);
    }
    add(t, &b);
}

/* Branches every `pitch` mm along those of one order, turned by about the golden angle from one to the next. */
static void add_order(tree *t, int order) {
    static const double pitch[ORDERS] = {8, 7, 9}, longest[ORDERS] = {70, 40, 18}; /* mm */
    const int last = t->count;
    for (int n = 0; n < last; n++) {
        if (t->branch[n].order != order) continue;
        const branch parent = t->branch[n];
        const double length = length_of(&parent);
        double azimuth = 2 * SKG_PI * random_of(t);
        for (double at = 0.6 * pitch[order]; at < 0.96 * length;
             at += pitch[order] * (0.8 + 0.4 * random_of(t))) {
            azimuth += 2.4 + 0.5 * random_of(t);
            add_side(t, &parent, fmax(at / length, 0.09), azimuth,
                     longest[order] * (0.7 + 0.3 * random_of(t)));
        }
    }
}

skg_status skg_shape_tree(const char *name, skg_tree_room room, const void *shape, double side,
                          double resolution, skg_mesh_arrays *arrays) {
    tree *t;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *t, name, &t));
    t->room = room, t->shape = shape, t->side = side, t->random = side > 0 ? 1 : 2;
    for (int n = 0; n < TRUNKS; n++) add_trunk(t, n);
    for (int order = 0; order + 1 < ORDERS; order++) add_order(t, order);
    for (int n = 0; n < t->count && status == SKG_OK; n++) {
        const branch *b = t->branch + n;
        static const double around[ORDERS] = {8, 6, 5};
        status = skg_shape_hose(name, (const double(*)[3])b->point, POINTS, b->first, b->last, side,
                                skg_shape_count(resolution, b->order == 0 ? 8 : 5, 3),
                                skg_shape_count(resolution, around[b->order], 4), arrays);
    }
    skg_free(&t);
    return status;
}
