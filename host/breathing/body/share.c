/* How much of a carrier's motion each vertex of an organ takes. */
#include "body/shares.h"

#include "body/bones.h"
#include "body/links.h"
#include "core/maths.h"

#include <string.h>

static int is_lung(const skg_body_organ *o) {
    return skg_label_begins(o->label, "lung");
}

static int is_liver(const skg_body_organ *o) {
    return skg_label_begins(o->label, "liver");
}

static const skg_body_organ *diaphragm_of(const skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == ROLE_DIAPHRAGM) return body->organ + i;
    return NULL;
}

int skg_is_anatomical(const skg_body *body) {
    return body->options.coupling == SKG_COUPLING_ANATOMICAL && body->options.hysteresis == 0 &&
           body->options.relaxation == 0;
}

int skg_is_coupled(const skg_body *body, const skg_body_organ *o) {
    int ribs = 0;
    if (!skg_is_anatomical(body)) return 0;
    for (int64_t i = 0; i < body->organs; i++) ribs += body->organ[i].role == ROLE_RIB;
    if (ribs == 0 || o->soft.given_count > 0) return 0;
    if (o->role == ROLE_DIAPHRAGM) return 1;
    if (o->role == ROLE_SPANNED) return skg_label_begins(o->label, "pulmonary vessels") && diaphragm_of(body);
    if (o->role != ROLE_LINKED) return 0;
    return skg_label_is_wall(o->label) ||
           ((is_lung(o) || is_liver(o) || skg_label_begins(o->label, "heart")) && diaphragm_of(body));
}

const double skg_dome_from = 0.8;

/* The space of the lungs: over the dome about half an ellipsoid. */
typedef struct {
    double centre[3], half[3];
} lung_space;

static lung_space find_lungs(const skg_body *body) {
    double low[3] = {HUGE_VAL, HUGE_VAL, 0}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    lung_space space;
    for (int64_t i = 0; i < body->organs; i++) {
        const skg_body_organ *o = body->organ + i;
        for (int k = 0; k < 3 && is_lung(o); k++)
            low[k] = fmin(low[k], o->bounds[k]), high[k] = fmax(high[k], o->bounds[3 + k]);
    }
    low[2] = 2 * diaphragm_of(body)->bounds[5] - high[2]; /* its middle is the top of the diaphragm */
    for (int k = 0; k < 3; k++)
        space.centre[k] = 0.5 * (low[k] + high[k]), space.half[k] = fmax(0.5 * (high[k] - low[k]), 1);
    return space;
}

/* The direction out of the wall of the lungs' space near a point. */
static void out_of(const lung_space *space, const double p[3], double normal[3]) {
    for (int k = 0; k < 3; k++) normal[k] = (p[k] - space->centre[k]) / (space->half[k] * space->half[k]);
    normal[2] = fmax(normal[2], 0);
    skg_scale_vector(1 / fmax(skg_length(normal), 1e-9), normal, normal);
}

/* The points of the diaphragm that are nearest to an organ over it. */
static skg_status find_base(const skg_body *body, skg_body_organ *o) {
    const skg_body_organ *d = diaphragm_of(body);
    const double height = find_lungs(body).half[2];
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->coupling.base, o->label, &o->coupling.base));
#pragma omp parallel for schedule(dynamic, 64)
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_link link = {.fraction = 1};
        skg_base *base = o->coupling.base + i;
        if (o->node_of[i] != i) continue;
        base->away = skg_nearest(d, o->rest + 3 * i, height, &link);
        for (int c = 0; c < 3; c++) base->corner[c] = link.corner[c], base->weight[c] = link.weight[c];
    }
    return SKG_OK;
}

/* Organs on the diaphragm move with it: their share falls with the height above it, and is 0 at the top of the lungs. Lungs, their vessels
 * and the heart do so alike, so that they stay beside each other. */
static void share_over_diaphragm(const skg_body *body, skg_body_organ *o) {
    const skg_body_organ *d = diaphragm_of(body);
    const double touching = 8; /* mm; the base goes with the diaphragm as a whole */
    const double height = find_lungs(body).half[2];
    for (int64_t i = 0; i < o->vertices; i++) {
        const skg_base *base = o->coupling.base + i;
        if (o->node_of[i] != i) continue;
        const double t = fmin(1 - (base->away - touching) / (height - touching), 1);
        o->coupling.share[i] = 0;
        for (int c = 0; c < 3 && base->away < height; c++)
            o->coupling.share[i] += t * t * base->weight[c] * d->coupling.share[d->node_of[base->corner[c]]];
    }
}

/* 0 up to `from`, 1 from `to` on, straight between them; or the other way round. */
static double ramp(double x, double from, double to) {
    return fmin(fmax((x - from) / (to - from), 0), 1);
}

static skg_status find_bones(const skg_body *body, skg_body_organ *o) {
    const int spine = o->role == ROLE_DIAPHRAGM;
    SKG_TRY(skg_alloc(BONES * o->vertices, sizeof *o->coupling.bone, o->label, &o->coupling.bone));
    SKG_TRY(
        skg_alloc(BONES * o->vertices, sizeof *o->coupling.bone_weight, o->label, &o->coupling.bone_weight));
    SKG_TRY(skg_alloc(BONES * o->vertices, sizeof *o->coupling.bone_base, o->label, &o->coupling.bone_base));
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->coupling.bone_away, o->label, &o->coupling.bone_away));
#pragma omp parallel for schedule(dynamic, 64)
    for (int64_t i = 0; i < o->vertices; i++)
        if (o->node_of[i] == i)
            o->coupling.bone_away[i] =
                skg_wall_bones(body, spine, o->rest + 3 * i, o->coupling.bone + BONES * i,
                               o->coupling.bone_base + BONES * i);
    return SKG_OK;
}

/* The displacement with the tendon at weight 1, and the weights of a vertex's bones. What lies farther than
 * `near` from bones follows them less, and from `far` on not at all: skin over the fat of the ribs, muscle, the lungs'
 * sides at the midplane. The diaphragm follows wholly, and stays beside the spine. A lung slides along the ribs: there it
 * has what the diaphragm gives along its surface only, and all of what the ribs give. */
static void find_course(const skg_body *body, skg_body_organ *o, int64_t i, const lung_space *lungs) {
    const int sheet = o->role == ROLE_DIAPHRAGM, wall = skg_label_is_wall(o->label);
    const double near = 22, far = wall ? 90 : 70, distance = o->coupling.bone_away[i];
    double *weight = o->coupling.bone_weight + BONES * i, *course = o->coupling.course + 3 * i, slides = 0,
           normal[3];
    skg_dome_motion(body, o->rest + 3 * i, course);
    skg_scale_vector(o->coupling.share[i], course, course);
    if (is_lung(o)) slides = ramp(o->coupling.base[i].away, 8, 45) * ramp(distance, 40, 16);
    if (slides > 0) {
        out_of(lungs, o->rest + 3 * i, normal);
        skg_add_scaled(course, -slides * skg_dot(course, normal), normal, course);
    }
    for (int b = 0; b < BONES; b++)
        weight[b] = o->coupling.bone_base[BONES * i + b] *
                    (fmax(1 - o->coupling.share[i], slides) * (sheet ? 1 : ramp(distance, far, near)));
}

/* Shares and courses from what was found of the meshes. */
skg_status skg_share_again(const skg_body *body, skg_body_organ *o) {
    lung_space lungs = {0};
    if (is_liver(o)) {
        skg_liver_course(body, diaphragm_of(body), o);
        return SKG_OK;
    }
    if (o->role == ROLE_DIAPHRAGM)
        skg_rim_share(body, o);
    else if (o->coupling.base)
        share_over_diaphragm(body, o);
    if (is_lung(o)) lungs = find_lungs(body);
    for (int64_t i = 0; i < o->vertices; i++)
        if (o->node_of[i] == i) find_course(body, o, i, &lungs);
    skg_free(&o->coupling.thin);
    return skg_thin_find(o);
}

skg_status skg_share_find(const skg_body *body, skg_body_organ *o) {
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->coupling.share, o->label, &o->coupling.share));
    SKG_TRY(skg_alloc(3 * o->vertices, sizeof *o->coupling.course, o->label, &o->coupling.course));
    if (is_liver(o)) {
        SKG_TRY(skg_liver_find(diaphragm_of(body), o));
        return skg_share_again(body, o);
    }
    if (o->role == ROLE_DIAPHRAGM)
        SKG_TRY(skg_rim_find(body, o));
    else if (!skg_label_is_wall(o->label))
        SKG_TRY(find_base(body, o));
    SKG_TRY(find_bones(body, o));
    return skg_share_again(body, o);
}

void skg_share_displace(const skg_body *body, skg_body_organ *o) {
    if (o->coupling.bone && body->bones_move)
        skg_wall_displace(body, o);
    else
        memset(o->moved, 0, (size_t)(3 * o->vertices) * sizeof *o->moved);
    for (int64_t i = 0; i < o->vertices && body->descended != 0; i++)
        skg_add_scaled(o->moved + 3 * i, body->descended, o->coupling.course + 3 * (int64_t)o->node_of[i],
                       o->moved + 3 * i);
}
