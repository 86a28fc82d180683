#include "body/thin.h"

#include "core/vector.h"

#include <string.h>

/* A facet is thin if it is less high than this part of its longest edge. In a deep breath the displacement changes by up
 * to 0.4 mm per mm; where that growth begins or ends beside the middle of an edge, the displacement there differs by up
 * to a tenth of the edge's length from the mean of its ends. */
static const double thin_below = 0.1;

/* The part of its height that a thin facet keeps: a choice. */
static const double kept = 0.1;

/* Opening a facet may fold one beside it. Most organs need two rounds, the second of which finds nothing to do. */
enum { ROUNDS = 16 };

static int32_t node(const skg_body_organ *o, int64_t triangle, int corner) {
    return o->node_of[o->corner[3 * triangle + corner % 3]];
}

/* Whether a facet is thin, and not without any area. first: the corner opposite its longest edge. foot: how far along
 * that edge, from the next corner to the one after, the point beside it lies. */
static int is_thin(const skg_body_organ *o, int64_t t, int *first, double *foot, double normal[3]) {
    double longest = 0, edge[3], to[3];
    for (int c = 0; c < 3; c++) {
        skg_add_scaled(o->rest + 3 * (int64_t)node(o, t, c + 2), -1, o->rest + 3 * (int64_t)node(o, t, c + 1),
                       edge);
        if (skg_dot(edge, edge) > longest) longest = skg_dot(edge, edge), *first = c;
    }
    if (longest == 0) return 0;
    const double *from = o->rest + 3 * (int64_t)node(o, t, *first + 1);
    skg_add_scaled(o->rest + 3 * (int64_t)node(o, t, *first + 2), -1, from, edge);
    skg_add_scaled(o->rest + 3 * (int64_t)node(o, t, *first), -1, from, to);
    skg_cross(edge, to, normal);
    *foot = skg_dot(edge, to) / longest;
    return skg_length(normal) < thin_below * longest && skg_dot(normal, normal) > 0;
}

/* The tendon moves as it is told, and does not give way. */
static double gives(const skg_body_organ *o, int32_t node) {
    return o->role == ROLE_DIAPHRAGM && o->share[node] == 1 ? 0 : 1;
}

static void fill(const skg_body_organ *o, int64_t t, int first, double foot, const double normal[3],
                 skg_thin *thin) {
    const double part[3] = {1, foot - 1, -foot};
    double sum = 0;
    memcpy(thin->normal, normal, sizeof thin->normal);
    for (int c = 0; c < 3; c++) {
        thin->corner[c] = node(o, t, first + c);
        sum += gives(o, thin->corner[c]) * part[c] * part[c];
    }
    for (int c = 0; c < 3; c++) thin->by[c] = sum > 0 ? gives(o, thin->corner[c]) * part[c] / sum : 0;
}

skg_status skg_thin_find(skg_body_organ *o) {
    int first = 0;
    double foot, normal[3];
    o->thins = 0;
    for (int64_t t = 0; t < o->triangles; t++) o->thins += is_thin(o, t, &first, &foot, normal);
    SKG_TRY(skg_alloc(o->thins, sizeof *o->thin, o->label, &o->thin));
    o->thins = 0;
    for (int64_t t = 0; t < o->triangles; t++)
        if (is_thin(o, t, &first, &foot, normal)) fill(o, t, first, foot, normal, o->thin + o->thins++);
    return SKG_OK;
}

/* A facet folds where the product of its normals at rest and as moved falls below 0. The product is linear in the place
 * of each corner, and grows fastest across the longest edge. Returns whether it was too small. */
static int open_facet(skg_body_organ *o, const skg_thin *thin) {
    double p[3][3], edge[3], to[3], now[3], grows[3];
    for (int c = 0; c < 3; c++)
        skg_add_scaled(o->rest + 3 * (int64_t)thin->corner[c], 1, o->moved + 3 * (int64_t)thin->corner[c],
                       p[c]);
    skg_add_scaled(p[2], -1, p[1], edge);
    skg_add_scaled(p[0], -1, p[1], to);
    skg_cross(edge, to, now);
    const double lacks = kept * skg_dot(thin->normal, thin->normal) - skg_dot(thin->normal, now);
    if (!(lacks > 0)) return 0;
    skg_cross(thin->normal, edge, grows);
    const double slope = skg_dot(grows, grows);
    for (int c = 0; c < 3 && slope > 0; c++) {
        double *u = o->moved + 3 * (int64_t)thin->corner[c];
        skg_add_scaled(u, thin->by[c] * lacks / slope, grows, u);
    }
    return 1;
}

int skg_thin_open(skg_body_organ *o) {
    int64_t opened = o->thins;
    int any = 0;
    for (int round = 0; round < ROUNDS && opened > 0; round++) {
        opened = 0;
        for (int64_t i = 0; i < o->thins; i++) opened += open_facet(o, o->thin + i);
        any |= opened > 0;
    }
    return any;
}
