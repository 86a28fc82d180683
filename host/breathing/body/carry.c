/* Organs that are carried by others: how each follows its carriers. */
#include "body/build.h"

#include "body/links.h"
#include "core/maths.h"

#include <string.h>

static const double anywhere = 1e4; /* mm; beyond any body */

/* The vessels in a lung: they go down with the diaphragm, the less the nearer they are to the apex. */
static int is_lung_vessels(const skg_body_organ *o) {
    return skg_label_begins(o->label, "pulmonary vessels");
}

/* Finds the CARRIERS vertices of the carrier that are nearest to each vertex. Their weights are 1/(d^2 + 1 mm^2),
 * made to add up to 1. */
static skg_status carry(skg_body *body, skg_body_organ *o, int32_t carrier) {
    const skg_body_organ *c = body->organ + carrier;
    o->carried.by = carrier;
    SKG_TRY(skg_alloc(CARRIERS * o->vertices, sizeof(int32_t), o->label, &o->carried.near));
    SKG_TRY(skg_alloc(CARRIERS * o->vertices, sizeof(double), o->label, &o->carried.weight));
    if (skg_label_begins(c->label, "liver"))
        SKG_TRY(skg_alloc(3 * o->vertices, sizeof(double), o->label, &o->coupling.beyond));
#pragma omp parallel for schedule(dynamic, 16)
    for (int64_t i = 0; i < o->vertices; i++) {
        int32_t *near = o->carried.near + CARRIERS * i;
        double *weight = o->carried.weight + CARRIERS * i, sum = 0;
        int found = 0;
        for (int64_t j = 0; j < c->vertices; j++) {
            double d[3];
            skg_add_scaled(c->rest + 3 * j, -1, o->rest + 3 * i, d);
            double w = 1 / (skg_dot(d, d) + 1);
            if (found == CARRIERS && w <= weight[CARRIERS - 1]) continue;
            int at = found < CARRIERS ? found++ : CARRIERS - 1;
            for (; at > 0 && weight[at - 1] < w; at--) weight[at] = weight[at - 1], near[at] = near[at - 1];
            weight[at] = w, near[at] = (int32_t)j;
        }
        for (int n = 0; n < found; n++) sum += weight[n];
        for (int n = 0; n < found; n++) weight[n] /= sum;
    }
    return SKG_OK;
}

/* Fraction of the carrier's motion: 1 at the lower end and 0 at the upper one, or the other way round. What lies in a
 * spanned organ, as gas in the bowel, moves as that does. */
static void span(const skg_body *body, skg_body_organ *o, int follows_below) {
    const skg_body_organ *outer = o->inside >= 0 ? body->organ + o->inside : o;
    const double *bounds = outer->role == ROLE_SPANNED || is_lung_vessels(o) ? outer->bounds : o->bounds;
    for (int64_t i = 0; i < o->vertices; i++) {
        double up = (o->rest[3 * i + 2] - bounds[2]) / (bounds[5] - bounds[2]);
        o->carried.fraction[i] = follows_below ? 1 - up : up;
    }
}

/* The needle's tip is the end that is nearer to the liver. It enters the skin where it is nearest to it. */
static skg_status place_needle(skg_body *body, skg_body_organ *o, int32_t liver, int32_t skin) {
    const double *bounds = body->organ[liver].bounds;
    double centre[3], d[3], far[3] = {0}, best = HUGE_VAL;
    int64_t tip = 0;
    enum { STEPS = 200 }; /* places along the needle that are tested: 1 mm apart for one of 200 mm */
    for (int k = 0; k < 3; k++) centre[k] = 0.5 * (bounds[k] + bounds[3 + k]);
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_add_scaled(o->rest + 3 * i, -1, centre, d);
        if (skg_length(d) < best) best = skg_length(d), tip = i;
    }
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_add_scaled(o->rest + 3 * i, -1, o->rest + 3 * tip, d);
        if (skg_length(d) > skg_length(far)) memcpy(far, d, sizeof far);
    }
    memcpy(o->needle.tip, o->rest + 3 * tip, sizeof o->needle.tip);
    best = HUGE_VAL;
    for (int s = 0; s <= STEPS; s++) {
        double p[3];
        skg_link link = {.fraction = 1, .organ = skin};
        skg_add_scaled(o->needle.tip, (double)s / STEPS, far, p);
        double to_skin = skg_nearest(body->organ + skin, p, anywhere, &link);
        if (to_skin < best) best = to_skin, o->needle.skin = link, memcpy(o->needle.pivot, p, sizeof p);
    }
    return carry(body, o, liver);
}

static int is_rigid(skg_role role) {
    return role == ROLE_RIB || role == ROLE_STERNUM || role == ROLE_RIGID;
}

/* Organs without a rule follow what they lie in, if that moves and is not the wall of the body; else they stay. */
skg_status skg_carry_adopt(skg_body *body, skg_body_organ *o) {
    if (o->kind == SKG_ORGAN_STATIC) return SKG_OK;
    const skg_body_organ *outer = o->inside >= 0 ? body->organ + o->inside : o;
    if (outer->role == ROLE_LINKED && !skg_label_is_wall(outer->label)) {
        o->role = ROLE_CARRIED;
        return carry(body, o, (int32_t)o->inside);
    }
    if (is_rigid(outer->role)) o->role = ROLE_ENCLOSED;
    if (o->role == ROLE_STATIC && !skg_label_stays(o->label) && !skg_label_stays(outer->label))
        skg_log(
            body->context, SKG_LOG_WARNING,
            "%s: there is no rule for this label, so it stays where it is. Rename it, or put it inside an organ "
            "that deforms.",
            o->label);
    return SKG_OK;
}

skg_status skg_carry_follow(skg_body *body, skg_body_organ *o) {
    int32_t liver = skg_find_organ(body, "liver"), skin = skg_find_organ(body, "skin"), lung = -1;
    for (int64_t l = 0; l < body->organs; l++) /* that of the same side, or any */
        if (skg_label_begins(body->organ[l].label, "lung") && (lung < 0 || body->organ[l].side == o->side))
            lung = (int32_t)l;
    int with_liver =
        skg_label_begins(o->label, "gallbladder") || skg_label_begins(o->label, "common bile duct");
    int with_lung = skg_label_begins(o->label, "trachea") || skg_label_begins(o->label, "bronchus") ||
                    skg_label_begins(o->label, "pulmonary artery");
    int with_heart = skg_label_begins(o->label, "ascending aorta") ||
                     skg_label_begins(o->label, "vena cava") || skg_label_begins(o->label, "pulmonary trunk");
    int32_t carrier = with_liver   ? liver
                      : with_lung  ? lung
                      : with_heart ? skg_find_organ(body, "heart")
                                   : LINK_TENDON;
    if (o->role == ROLE_NEEDLE ? liver < 0 || skin < 0 : carrier == -1) {
        o->role = ROLE_STATIC;
        skg_log(body->context, SKG_LOG_WARNING,
                "%s: what it follows is not in the body, so it stays where it is", o->label);
        return SKG_OK;
    }
    /* In dynamic MR, kidneys move by 0.6 to 0.7 of the diaphragm. */
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->carried.fraction, o->label, &o->carried.fraction));
    for (int64_t i = 0; i < o->vertices; i++)
        o->carried.fraction[i] =
            skg_label_begins(o->label, "kidney") || skg_label_begins(o->label, "perirenal fat") ? 0.65 : 1;
    if (o->role == ROLE_SPANNED) span(body, o, with_lung || with_heart || is_lung_vessels(o));
    if (o->role == ROLE_NEEDLE) return place_needle(body, o, liver, skin);
    o->carried.by = LINK_TENDON;
    return carrier >= 0 ? carry(body, o, carrier) : SKG_OK;
}

/* A cartilage lies between its rib (fraction 0) and the sternum (fraction 1). Below the seventh it ends at the
 * cartilage above, which moves there about as the rib above does. */
skg_status skg_carry_cartilage(skg_body *body, skg_body_organ *o) {
    int32_t rib = -1, other = -1;
    for (int64_t i = 0; i < body->organs; i++) {
        const skg_body_organ *c = body->organ + i;
        if (c->role == ROLE_RIB && c->number == o->number && c->side == o->side) rib = (int32_t)i;
        if (c->role == ROLE_STERNUM && o->number <= 7) other = (int32_t)i;
        if (c->role == ROLE_RIB && o->number > 7 && c->number == o->number - 1 && c->side == o->side)
            other = (int32_t)i;
    }
    if (rib < 0 || other < 0) {
        o->role = ROLE_STATIC;
        skg_log(body->context, SKG_LOG_WARNING,
                "%s: its rib or the sternum is not in the body, so it stays where it is", o->label);
        return SKG_OK;
    }
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->carried.fraction, o->label, &o->carried.fraction));
    SKG_TRY(skg_alloc(2, sizeof *o->carried.near, o->label, &o->carried.near));
    o->carried.near[0] = rib, o->carried.near[1] = other;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_link unused;
        o->carried.fraction[i] = skg_nearest(body->organ + rib, o->rest + 3 * i, anywhere, &unused);
        low = fmin(low, o->carried.fraction[i]), high = fmax(high, o->carried.fraction[i]);
    }
    for (int64_t i = 0; i < o->vertices; i++) {
        double t = (o->carried.fraction[i] - low) / (high - low);
        o->carried.fraction[i] = t * t * (3 - 2 * t); /* constant at both ends, where bone begins */
    }
    return SKG_OK;
}
