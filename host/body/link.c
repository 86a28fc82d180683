/* Links between organs, found once, at rest. */
#include "body/body.h"

#include "core/vector.h"

#include <inttypes.h>
#include <string.h>

static int32_t find_organ(const skg_body *body, const char *word) {
    for (int64_t o = 0; o < body->organs; o++)
        if (skg_label_begins(body->organ[o].label, word)) return (int32_t)o;
    return -1;
}

/* The nearest point of the organs with a role and a range of rib numbers. */
static double nearest_of(const skg_body *body, skg_role role, int first, int last, const double p[3],
                         double reach, skg_link *link) {
    double least = HUGE_VAL;
    for (int64_t o = 0; o < body->organs; o++) {
        const skg_body_organ *organ = body->organ + o;
        if (organ->role != role || organ->number < first || organ->number > last) continue;
        skg_link found = {.part = 1};
        double d = skg_nearest(organ, p, fmin(reach, least), &found);
        if (d < least) least = d, *link = found, link->organ = (int32_t)o;
    }
    return least;
}

/* Which vertices of an organ are driven, and by what: 1 and the link, or 0. */
typedef int (*link_rule)(const skg_body *body, const skg_body_organ *organ, const double p[3],
                         skg_link *link);

static double plane_value(const skg_body *body, const double p[3]) {
    return skg_dot(body->options.tendon_plane, p) + body->options.tendon_plane[3];
}

/* The tendon is driven; the lowest part of the muscle goes with the ribs near it, or stays beside the spine.
 */
static int diaphragm_rule(const skg_body *body, const skg_body_organ *organ, const double p[3],
                          skg_link *link) {
    const double *bounds = organ->bounds;
    *link = (skg_link){.organ = LINK_TENDON, .part = 1};
    if (plane_value(body, p) > 0) return 1;
    if (p[2] > bounds[2] + 0.1 * (bounds[5] - bounds[2])) return 0;
    if (nearest_of(body, ROLE_RIB, 6, 12, p, 16, link) < HUGE_VAL) return 1;
    *link = (skg_link){.organ = LINK_STAYS};
    for (int64_t o = 0; o < body->organs; o++) {
        skg_link spine;
        if (skg_label_stays(body->organ[o].label) && skg_nearest(body->organ + o, p, 12, &spine) < HUGE_VAL)
            return 1;
    }
    return 0;
}

/* The base goes with the diaphragm, the upper wall with the ribs; between them the lung slides. */
static int lung_rule(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link) {
    skg_link base;
    (void)organ;
    double to_base = nearest_of(body, ROLE_DIAPHRAGM, 0, 0, p, 45, &base);
    *link = base;
    if (to_base < 16) return 1;
    return to_base == HUGE_VAL && nearest_of(body, ROLE_RIB, 2, 7, p, 16, link) < HUGE_VAL;
}

/* What hangs on the tendon or lies on it. */
static int tendon_rule(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link) {
    (void)organ;
    if (nearest_of(body, ROLE_DIAPHRAGM, 0, 0, p, 9, link) == HUGE_VAL) return 0;
    int tendon = 1;
    for (int c = 0; c < 3; c++)
        tendon &= plane_value(body, body->organ[link->organ].rest + 3 * link->corner[c]) > 0;
    return tendon;
}

/* Skin over the ribs' fat goes with them; the farther away, the less (mm: a choice). */
static int skin_rule(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link) {
    const double near = 22, far = 60;
    skg_link sternum;
    (void)organ;
    double to_rib = nearest_of(body, ROLE_RIB, 1, 10, p, far, link);
    double to_sternum = nearest_of(body, ROLE_STERNUM, 0, 0, p, fmin(to_rib, far), &sternum);
    if (to_sternum < to_rib) *link = sternum;
    double least = fmin(to_rib, to_sternum);
    link->part = fmin(1, (far - least) / (far - near));
    return least < far;
}

/* Cartilage grows on the ends of ribs and on the edge of the sternum. */
static int cartilage_rule(const skg_body *body, const skg_body_organ *organ, const double p[3],
                          skg_link *link) {
    const double reach = 5; /* mm: a joint and half a bone's thickness (a choice) */
    skg_link sternum;
    (void)organ;
    double to_rib = nearest_of(body, ROLE_RIB, 1, 10, p, reach, link);
    double to_sternum = nearest_of(body, ROLE_STERNUM, 0, 0, p, fmin(to_rib, reach), &sternum);
    if (to_sternum < to_rib) *link = sternum;
    if (fmin(to_rib, to_sternum) == HUGE_VAL) return 0;
    skg_link_fix(body, p, link);
    return 1;
}

static link_rule rule_of(const skg_body_organ *organ) {
    if (organ->role == ROLE_DIAPHRAGM) return diaphragm_rule;
    if (skg_label_begins(organ->label, "lung")) return lung_rule;
    if (skg_label_begins(organ->label, "cartilage")) return cartilage_rule;
    return skg_label_begins(organ->label, "skin") ? skin_rule : tendon_rule;
}

/* How a vertex is driven. */
enum { FREE, FOLLOWS, HANGS };

/* Which vertices follow what, by the caller's links or by the label's rule. */
static int64_t find_drivers(const skg_body *body, const skg_body_organ *o, skg_link *link, int32_t *how) {
    const link_rule rule = rule_of(o);
    int64_t hanging = 0;
#pragma omp parallel for schedule(dynamic, 64) reduction(+ : hanging)
    for (int64_t i = 0; i < o->vertices; i++) {
        const double *p = o->rest + 3 * i;
        double rigid = 0;
        how[i] = FREE;
        if (o->node_of[i] != i) continue;
        if (o->given_count == 0) {
            how[i] = rule(body, o, p, link + i) ? FOLLOWS : FREE;
            continue;
        }
        const double distance = skg_given_link(body, o, p, link + i, &rigid);
        how[i] = distance == HUGE_VAL ? FREE : distance <= rigid ? FOLLOWS : HANGS;
        if (how[i] == FOLLOWS) skg_link_fix(body, p, link + i);
        hanging += how[i] == HANGS;
    }
    return hanging;
}

static void point_on(const skg_body *body, const skg_link *link, double p[3]) {
    memset(p, 0, 3 * sizeof *p);
    for (int c = 0; c < 3; c++)
        skg_add_scaled(p, link->weight[c], body->organ[link->organ].rest + 3 * (int64_t)link->corner[c], p);
}

/* What a chain is made of, until it is. A vertex that hangs does so by one more link, from a node of its own
 * at the other organ. */
typedef struct {
    int64_t nodes, links;
    double *rest;
    int32_t *ends, *how, *driven;
} chain_parts;

static skg_status add_hanging(const skg_body *body, skg_body_organ *o, int64_t hanging, chain_parts *c) {
    SKG_TRY(skg_alloc(3 * (o->vertices + hanging), sizeof *c->rest, o->label, &c->rest));
    SKG_TRY(skg_alloc(o->vertices, sizeof *c->driven, o->label, &c->driven));
    SKG_TRY(skg_realloc(2 * (c->links + hanging), sizeof *c->ends, o->label, &c->ends));
    memcpy(c->rest, o->rest, (size_t)(3 * o->vertices) * sizeof *c->rest);
    c->nodes = o->vertices;
    for (int64_t i = 0; i < o->vertices; i++) {
        if (c->how[i] == FREE) continue;
        int32_t node = (int32_t)i;
        if (c->how[i] == HANGS) {
            node = (int32_t)c->nodes++;
            point_on(body, o->link + i, c->rest + 3 * (int64_t)node);
            c->ends[2 * c->links] = (int32_t)i, c->ends[2 * c->links++ + 1] = node;
        }
        o->link[o->links] = o->link[i], c->driven[o->links++] = node;
    }
    return SKG_OK;
}

static skg_status build_chain(skg_body *body, skg_body_organ *o, chain_parts *c) {
    SKG_TRY(skg_chain_links(o->triangles, o->corner, o->node_of, &c->links, &c->ends));
    if (o->role == ROLE_DIAPHRAGM) SKG_TRY(skg_body_add_struts(o, &c->links, &c->ends));
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->link, o->label, &o->link));
    SKG_TRY(skg_alloc(o->vertices, sizeof *c->how, o->label, &c->how));
    SKG_TRY(add_hanging(body, o, find_drivers(body, o, o->link, c->how), c));
    SKG_TRY(skg_chain_create(o->label, c->nodes, c->rest, c->links, c->ends, &o->tissue, 1, NULL, &o->chain));
    SKG_TRY(skg_chain_drive(o->chain, o->links, c->driven));
    SKG_TRY(skg_alloc(3 * c->nodes, sizeof(double), o->label, &o->state));
    SKG_TRY(skg_alloc(3 * c->nodes, sizeof(double), o->label, &o->memory));
    SKG_TRY(skg_alloc(3 * o->links, sizeof(double), o->label, &o->target));
    SKG_TRY(skg_alloc(3 * o->links, sizeof(double), o->label, &o->anchor));
    for (int64_t d = 0; d < o->links; d++)
        memcpy(o->anchor + 3 * d, c->rest + 3 * (int64_t)c->driven[d], 3 * sizeof(double));
    o->corotates = skg_corotates(body, o);
    if (o->links == 0)
        skg_log(
            body->context, SKG_LOG_WARNING,
            "%s: deformable, but nothing that it is linked to is near enough; it stays where it is (longer "
            "links, or another organ to follow)",
            o->label);
    return SKG_OK;
}

static skg_status make_chain(skg_body *body, skg_body_organ *o) {
    chain_parts c = {0};
    skg_status status = build_chain(body, o, &c);
    skg_free(&c.rest);
    skg_free(&c.ends);
    skg_free(&c.how);
    skg_free(&c.driven);
    return status;
}

/* The CARRIERS vertices of the carrier nearest to each vertex, weighted by 1/(d^2 + 1 mm^2). */
static skg_status carry(skg_body *body, skg_body_organ *o, int32_t carrier) {
    const skg_body_organ *c = body->organ + carrier;
    o->carrier = carrier;
    SKG_TRY(skg_alloc(CARRIERS * o->vertices, sizeof(int32_t), o->label, &o->near));
    SKG_TRY(skg_alloc(CARRIERS * o->vertices, sizeof(double), o->label, &o->near_weight));
#pragma omp parallel for schedule(dynamic, 16)
    for (int64_t i = 0; i < o->vertices; i++) {
        int32_t *near = o->near + CARRIERS * i;
        double *weight = o->near_weight + CARRIERS * i, sum = 0;
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

/* How much of the carrier's motion: 1 at the lower end and 0 at the upper one, or the other way round. */
static skg_status span(skg_body_organ *o, int follows_below) {
    const double *bounds = o->bounds;
    for (int64_t i = 0; i < o->vertices; i++) {
        double up = (o->rest[3 * i + 2] - bounds[2]) / (bounds[5] - bounds[2]);
        o->share[i] = follows_below ? 1 - up : up;
    }
    return SKG_OK;
}

/* The needle's tip is its end nearer to the liver; it enters where it is nearest to the skin. */
static skg_status place_needle(skg_body *body, skg_body_organ *o, int32_t liver, int32_t skin) {
    const double *bounds = body->organ[liver].bounds;
    double centre[3], d[3], far[3] = {0}, best = HUGE_VAL;
    int64_t tip = 0;
    for (int k = 0; k < 3; k++) centre[k] = 0.5 * (bounds[k] + bounds[3 + k]);
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_add_scaled(o->rest + 3 * i, -1, centre, d);
        if (skg_length(d) < best) best = skg_length(d), tip = i;
    }
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_add_scaled(o->rest + 3 * i, -1, o->rest + 3 * tip, d);
        if (skg_length(d) > skg_length(far)) memcpy(far, d, sizeof far);
    }
    memcpy(o->tip, o->rest + 3 * tip, sizeof o->tip);
    best = HUGE_VAL;
    for (int s = 0; s <= 200; s++) {
        double p[3];
        skg_link link = {.part = 1, .organ = skin};
        skg_add_scaled(o->tip, s / 200.0, far, p);
        double to_skin = skg_nearest(body->organ + skin, p, 1e4, &link);
        if (to_skin < best) best = to_skin, o->skin = link, memcpy(o->pivot, p, sizeof p);
    }
    return carry(body, o, liver);
}

/* Parts without a rule: with what they lie in, if that deforms; else they stay. */
static skg_status adopt(skg_body *body, skg_body_organ *o) {
    if (o->kind == SKG_ORGAN_STATIC) return SKG_OK;
    skg_role outer = o->inside >= 0 ? body->organ[o->inside].role : ROLE_STATIC;
    int skin = o->inside >= 0 && skg_label_begins(body->organ[o->inside].label, "skin");
    if (outer == ROLE_LINKED && !skin) {
        o->role = ROLE_CARRIED;
        return carry(body, o, (int32_t)o->inside);
    }
    if (!skg_label_stays(o->label))
        skg_log(body->context, SKG_LOG_WARNING,
                "%s: no rule for this label; it stays where it is (rename it, or put it inside an organ that "
                "moves)",
                o->label);
    return SKG_OK;
}

static skg_status follow(skg_body *body, skg_body_organ *o) {
    int32_t liver = find_organ(body, "liver"), skin = find_organ(body, "skin"), lung = -1;
    for (int64_t l = 0; l < body->organs; l++) /* of the same side, or any */
        if (skg_label_begins(body->organ[l].label, "lung") && (lung < 0 || body->organ[l].side == o->side))
            lung = (int32_t)l;
    int with_liver =
        skg_label_begins(o->label, "gallbladder") || skg_label_begins(o->label, "common bile duct");
    int with_lung = skg_label_begins(o->label, "trachea") || skg_label_begins(o->label, "bronchus");
    int32_t carrier = with_liver ? liver : with_lung ? lung : LINK_TENDON;
    if (o->role == ROLE_NEEDLE ? liver < 0 || skin < 0 : carrier == -1) {
        o->role = ROLE_STATIC;
        skg_log(body->context, SKG_LOG_WARNING, "%s: what it follows is not in the body; it stays", o->label);
        return SKG_OK;
    }
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->share, o->label, &o->share));
    for (int64_t i = 0; i < o->vertices; i++) o->share[i] = skg_label_begins(o->label, "kidney") ? 0.65 : 1;
    if (o->role == ROLE_SPANNED) SKG_TRY(span(o, with_lung));
    if (o->role == ROLE_NEEDLE) return place_needle(body, o, liver, skin);
    o->carrier = LINK_TENDON;
    return carrier >= 0 ? carry(body, o, carrier) : SKG_OK;
}

/* A cartilage goes from its rib (share 0) to the sternum, or to the cartilage above, which there goes about
 * as its own rib does (share 1). */
static skg_status tie_cartilage(skg_body *body, skg_body_organ *o) {
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
        skg_log(body->context, SKG_LOG_WARNING, "%s: its rib or the sternum is not in the body; it stays",
                o->label);
        return SKG_OK;
    }
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->share, o->label, &o->share));
    SKG_TRY(skg_alloc(2, sizeof *o->near, o->label, &o->near));
    o->near[0] = rib, o->near[1] = other;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_link unused;
        o->share[i] = skg_nearest(body->organ + rib, o->rest + 3 * i, 1e4, &unused);
        low = fmin(low, o->share[i]), high = fmax(high, o->share[i]);
    }
    for (int64_t i = 0; i < o->vertices; i++) {
        double t = (o->share[i] - low) / (high - low);
        o->share[i] = t * t * (3 - 2 * t); /* flat at both ends, where bone begins */
    }
    return SKG_OK;
}

static void default_plane(skg_body *body) {
    double *plane = body->options.tendon_plane;
    int32_t d = find_organ(body, "diaphragm");
    if (d < 0 || plane[0] != 0 || plane[1] != 0 || plane[2] != 0) return;
    const double *b = body->organ[d].bounds;
    /* the upper third, tilted by 45 degrees so that the steep front is muscle */
    plane[1] = 1, plane[2] = 1;
    plane[3] = -0.5 * (b[1] + b[4]) - (b[5] - 0.3 * (b[5] - b[2]));
}

skg_status skg_body_find_links(skg_body *body) {
    default_plane(body);
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == ROLE_RIB) SKG_TRY(skg_rib_prepare(body, body->organ + i));
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        if (o->role == ROLE_CARTILAGE) SKG_TRY(tie_cartilage(body, o));
        if (o->role == ROLE_CARRIED || o->role == ROLE_SPANNED || o->role == ROLE_NEEDLE)
            SKG_TRY(follow(body, o));
        if (o->role == ROLE_STATIC) SKG_TRY(adopt(body, o));
    }
    SKG_TRY(skg_body_check_ties(body));
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == ROLE_DIAPHRAGM || body->organ[i].role == ROLE_LINKED)
            SKG_TRY(make_chain(body, body->organ + i));
    return SKG_OK;
}
