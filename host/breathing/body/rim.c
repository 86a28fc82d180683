/* The rim of the diaphragm, which stays with the wall. */
#include "body/shares.h"

#include "body/links.h"
#include "core/maths.h"

#include <stdlib.h>

/* Directions in which the rim's height is found, and the part of the height over it that belongs to it, the width of
 * the insertion: choices. */
enum { SECTORS = 72 };
static const double insertion = 0.1;

/* Greatest slope of the rim. The generated one has 1.3, from the xiphoid to the flanks. */
static const double steepest = 2;

typedef struct {
    double centre[2], top, low[SECTORS];
} rim;

/* The direction of a point from the centre, in sectors, 0 to below SECTORS. */
static double direction_of(const rim *r, const double *p) {
    const double turns = atan2(p[1] - r->centre[1], p[0] - r->centre[0]) / (2 * SKG_PI);
    const double at = (turns - floor(turns)) * SECTORS;
    return at < SECTORS ? at : 0;
}

/* The lowest vertex of each sector; where that is far above those beside it, as in a sector of a coarse mesh that has no
 * vertex at the rim, what a slope from there gives. */
static void find_rim(const skg_body_organ *o, rim *r) {
    double low[SECTORS], radius = 0;
    for (int k = 0; k < 2; k++) {
        r->centre[k] = 0.5 * (o->bounds[k] + o->bounds[3 + k]);
        radius = fmax(radius, 0.5 * (o->bounds[3 + k] - o->bounds[k]));
    }
    r->top = o->bounds[5];
    for (int s = 0; s < SECTORS; s++) low[s] = HUGE_VAL;
    for (int64_t i = 0; i < o->vertices; i++) {
        double *at = low + (int)direction_of(r, o->rest + 3 * i);
        *at = fmin(*at, o->rest[3 * i + 2]);
    }
    for (int s = 0; s < SECTORS; s++) {
        r->low[s] = low[s];
        for (int other = 0; other < SECTORS; other++) {
            const int away = abs(s - other), turns = away < SECTORS - away ? away : SECTORS - away;
            r->low[s] = fmin(r->low[s], low[other] + steepest * turns * 2 * SKG_PI / SECTORS * radius);
        }
    }
}

static int is_rim(const rim *r, const double *p) {
    const double at = direction_of(r, p) + SECTORS - 0.5; /* from the middle of a sector */
    const int s = (int)at;
    const double low = r->low[s % SECTORS] + (at - s) * (r->low[(s + 1) % SECTORS] - r->low[s % SECTORS]);
    return p[2] <= low + insertion * (r->top - low);
}

/* Where the tendon is the caller's, the muscle ends there. */
static skg_status share_to_plane(const double plane[4], skg_body_organ *o, unsigned char *given,
                                 int64_t struts, const int32_t *ends) {
    double *to_tendon;
    SKG_TRY(skg_alloc(o->vertices, sizeof *to_tendon, o->label, &to_tendon));
    for (int64_t i = 0; i < o->vertices; i++) given[i] = skg_dot(plane, o->rest + 3 * i) + plane[3] > 0;
    skg_status status = skg_surface_distance(o, given, struts, ends, to_tendon);
    for (int64_t i = 0; i < o->vertices; i++)
        o->coupling.way[i] =
            given[i] ? 1 : o->coupling.way[i] / fmax(o->coupling.way[i] + to_tendon[i], 1e-9);
    skg_free(&to_tendon);
    return status;
}

void skg_rim_share(const skg_body *body, skg_body_organ *o) {
    const double muscle = body->plane_given ? 1 : body->options.muscle_length * o->coupling.farthest;
    for (int64_t i = 0; i < o->vertices; i++)
        o->coupling.share[i] = fmin(1, muscle > 0 ? o->coupling.way[i] / muscle : o->coupling.way[i]);
}

skg_status skg_rim_find(const skg_body *body, skg_body_organ *o) {
    unsigned char *given = NULL;
    int32_t *ends = NULL;
    int64_t struts = 0;
    rim r;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(o->vertices, sizeof *o->coupling.way, o->label, &o->coupling.way));
    SKG_TRY_CLEANUP(skg_alloc(o->vertices, sizeof *given, o->label, &given));
    SKG_TRY_CLEANUP(skg_body_add_struts(o, &struts, &ends));
    find_rim(o, &r);
    for (int64_t i = 0; i < o->vertices; i++) given[i] = (unsigned char)is_rim(&r, o->rest + 3 * i);
    SKG_TRY_CLEANUP(skg_surface_distance(o, given, struts, ends, o->coupling.way));
    o->coupling.farthest = 0;
    for (int64_t i = 0; i < o->vertices; i++)
        if (o->node_of[i] == i) o->coupling.farthest = fmax(o->coupling.farthest, o->coupling.way[i]);
    if (body->plane_given) status = share_to_plane(body->options.tendon_plane, o, given, struts, ends);
cleanup:
    skg_free(&given);
    skg_free(&ends);
    return status;
}
