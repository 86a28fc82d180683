/* Where an organ is so thin that its two sides are close. */
#include "body/shares.h"

#include "core/maths.h"

#include <string.h>

/* A facet is thin if it is less high than this part of its longest edge. In a deep breath the displacement changes by up
 * to 0.4 mm per mm; where that growth begins or ends beside the middle of an edge, the displacement there differs by up
 * to a tenth of the edge's length from the mean of its ends. */
static const double thin_below = 0.1;

/* The part of its height that a thin facet keeps: a choice. */
static const double kept = 0.1;

/* Of the product of normals. What lacks less was opened before. */
static const double rounding = 1e-9;

/* Opening a facet may fold one beside it. Most organs need two rounds, the second of which finds nothing to do. */
enum { ROUNDS = 16 };

static int32_t node(const skg_body_organ *o, int64_t triangle, int corner) {
    return o->node_of[o->corner[3 * triangle + corner % 3]];
}

static void side(const skg_body_organ *o, int32_t from, int32_t to, double edge[3]) {
    skg_add_scaled(o->rest + 3 * (int64_t)to, -1, o->rest + 3 * (int64_t)from, edge);
}

/* The tendon moves as it is told, and does not give way. */
static double gives(const skg_body_organ *o, int32_t node) {
    return o->role == ROLE_DIAPHRAGM && o->coupling.share[node] == 1 ? 0 : 1;
}

/* Fills the description of any facet. Returns its height over its longest edge; 0: it has no area. */
static double describe(const skg_body_organ *o, int64_t t, skg_thin *facet) {
    double longest = 0, edge[3], to[3], sum = 0;
    int first = 0;
    for (int c = 0; c < 3; c++) {
        side(o, node(o, t, c + 1), node(o, t, c + 2), edge);
        if (skg_dot(edge, edge) > longest) longest = skg_dot(edge, edge), first = c;
    }
    for (int c = 0; c < 3; c++) facet->corner[c] = node(o, t, first + c);
    side(o, facet->corner[1], facet->corner[2], edge);
    side(o, facet->corner[1], facet->corner[0], to);
    skg_cross(edge, to, facet->normal);
    if (!(skg_dot(facet->normal, facet->normal) > 0)) return 0;
    const double foot = skg_dot(edge, to) / longest, part[3] = {1, foot - 1, -foot};
    for (int c = 0; c < 3; c++) sum += gives(o, facet->corner[c]) * part[c] * part[c];
    for (int c = 0; c < 3; c++) facet->by[c] = sum > 0 ? gives(o, facet->corner[c]) * part[c] / sum : 0;
    return skg_length(facet->normal) / longest;
}

static int is_thin(double height) {
    return height > 0 && height < thin_below;
}

skg_status skg_thin_find(skg_body_organ *o) {
    skg_thin facet = {.reserved = 0};
    o->coupling.thins = 0;
    for (int64_t t = 0; t < o->triangles; t++) o->coupling.thins += is_thin(describe(o, t, &facet));
    SKG_TRY(skg_alloc(o->coupling.thins, sizeof *o->coupling.thin, o->label, &o->coupling.thin));
    o->coupling.thins = 0;
    for (int64_t t = 0; t < o->triangles; t++)
        if (is_thin(describe(o, t, &facet))) o->coupling.thin[o->coupling.thins++] = facet;
    return SKG_OK;
}

/* A facet folds where the product of its normals at rest and as moved falls below 0. The product is linear in the place
 * of each corner, and grows fastest across the longest edge. Returns whether it was too small. */
static int open_facet(skg_body_organ *o, const skg_thin *facet) {
    double p[3][3], edge[3], to[3], now[3], grows[3];
    for (int c = 0; c < 3; c++)
        skg_add_scaled(o->rest + 3 * (int64_t)facet->corner[c], 1, o->moved + 3 * (int64_t)facet->corner[c],
                       p[c]);
    skg_add_scaled(p[2], -1, p[1], edge);
    skg_add_scaled(p[0], -1, p[1], to);
    skg_cross(edge, to, now);
    const double rest = skg_dot(facet->normal, facet->normal),
                 lacks = kept * rest - skg_dot(facet->normal, now);
    if (!(lacks > rounding * rest)) return 0;
    skg_cross(facet->normal, edge, grows);
    const double slope = skg_dot(grows, grows);
    for (int c = 0; c < 3 && slope > 0; c++) {
        double *u = o->moved + 3 * (int64_t)facet->corner[c];
        skg_add_scaled(u, facet->by[c] * lacks / slope, grows, u);
    }
    return 1;
}

static int open_thin(skg_body_organ *o) {
    int opened = 0;
    for (int64_t i = 0; i < o->coupling.thins; i++) opened |= open_facet(o, o->coupling.thin + i);
    return opened;
}

static int open_all(skg_body_organ *o) {
    int opened = 0;
    for (int64_t t = 0; t < o->triangles; t++) {
        skg_thin facet = {.reserved = 0};
        if (describe(o, t, &facet) > 0) opened |= open_facet(o, &facet);
    }
    return opened;
}

int skg_thin_open(skg_body_organ *o, int all) {
    int any = 0, opened = 1;
    for (int round = 0; round < ROUNDS && opened; round++) {
        opened = all ? open_all(o) : open_thin(o);
        any |= opened;
    }
    return any;
}
