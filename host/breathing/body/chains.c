/* Chains of points between a moving and a resting organ, which share the motion. */
#include "body/build.h"

#include "body/links.h"
#include "body/posed.h"
#include "body/shares.h"
#include "core/maths.h"

#include <string.h>

/* How a vertex is driven: not at all, moved with a point of another organ, or by a link to such a point. */
enum { FREE, FOLLOWS, HANGS };

/* How each vertex is driven, by the caller's links or by the label's rule, and the number of those that hang. */
static int64_t find_drivers(const skg_body *body, const skg_body_organ *o, skg_link *link, int32_t *how) {
    const skg_link_rule rule = skg_link_rule_of(o);
    int64_t hanging = 0;
#pragma omp parallel for schedule(dynamic, 64) reduction(+ : hanging)
    for (int64_t i = 0; i < o->vertices; i++) {
        const double *p = o->rest + 3 * i;
        double rigid = 0;
        how[i] = FREE;
        if (o->node_of[i] != i) continue;
        if (o->soft.given_count == 0) {
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

/* Nodes and links of a chain to be made. A vertex that hangs has one more link, to a node of its own at the other organ, which is driven. */
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
            point_on(body, o->soft.link + i, c->rest + 3 * (int64_t)node);
            c->ends[2 * c->links] = (int32_t)i, c->ends[2 * c->links++ + 1] = node;
        }
        o->soft.link[o->soft.links] = o->soft.link[i], c->driven[o->soft.links++] = node;
    }
    return SKG_OK;
}

/* Of an organ that follows ribs and dome together, links only limit how far it deforms; nothing drives it. */
static skg_status build_coupled(const skg_body *body, skg_body_organ *o, const chain_parts *c) {
    if (o->tissue_by_label) o->tissue = skg_coupled_tissue_of(o->label);
    SKG_TRY(skg_chain_create(o->label, o->vertices, o->rest, c->links, c->ends, &o->tissue, 1, NULL,
                             &o->soft.chain));
    SKG_TRY(skg_alloc(3 * o->vertices, sizeof(double), o->label, &o->soft.state));
    return skg_share_find(body, o);
}

static skg_status build_chain(skg_body *body, skg_body_organ *o, chain_parts *c) {
    SKG_TRY(skg_chain_links(o->triangles, o->corner, o->node_of, &c->links, &c->ends));
    if (o->role == ROLE_DIAPHRAGM) SKG_TRY(skg_body_add_struts(o, &c->links, &c->ends));
    if (o->coupled) return build_coupled(body, o, c);
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->soft.link, o->label, &o->soft.link));
    SKG_TRY(skg_alloc(o->vertices, sizeof *c->how, o->label, &c->how));
    SKG_TRY(add_hanging(body, o, find_drivers(body, o, o->soft.link, c->how), c));
    SKG_TRY(skg_chain_create(o->label, c->nodes, c->rest, c->links, c->ends, &o->tissue, 1, NULL,
                             &o->soft.chain));
    SKG_TRY(skg_chain_drive(o->soft.chain, o->soft.links, c->driven));
    SKG_TRY(skg_alloc(3 * c->nodes, sizeof(double), o->label, &o->soft.state));
    SKG_TRY(skg_alloc(3 * c->nodes, sizeof(double), o->label, &o->soft.memory));
    SKG_TRY(skg_alloc(3 * o->soft.links, sizeof(double), o->label, &o->soft.target));
    SKG_TRY(skg_alloc(3 * o->soft.links, sizeof(double), o->label, &o->soft.anchor));
    for (int64_t d = 0; d < o->soft.links; d++)
        memcpy(o->soft.anchor + 3 * d, c->rest + 3 * (int64_t)c->driven[d], 3 * sizeof(double));
    o->soft.corotates = skg_corotates(body, o);
    o->soft.unfolds =
        o->soft.given_count == 0 && skg_is_anatomical(body) && skg_label_begins(o->label, "cartilage");
    if (o->soft.links == 0)
        skg_log(
            body->context, SKG_LOG_WARNING,
            "%s: deformable, but nothing that it is linked to is near enough, so it stays where it is. Give it "
            "longer links, or another organ to follow.",
            o->label);
    return SKG_OK;
}

skg_status skg_body_make_chain(skg_body *body, skg_body_organ *o) {
    chain_parts c = {0};
    skg_status status = build_chain(body, o, &c);
    skg_free(&c.rest);
    skg_free(&c.ends);
    skg_free(&c.how);
    skg_free(&c.driven);
    return status;
}

void skg_body_drop_chain(skg_body_organ *o) {
    skg_chain_free(&o->soft.chain);
    void *block[] = {&o->soft.link,          &o->soft.anchor,       &o->soft.target,
                     &o->soft.state,         &o->soft.memory,       &o->coupling.share,
                     &o->coupling.course,    &o->coupling.bone,     &o->coupling.bone_weight,
                     &o->coupling.thin,      &o->coupling.way,      &o->coupling.base,
                     &o->coupling.bone_base, &o->coupling.bone_away};
    for (size_t i = 0; i < sizeof block / sizeof *block; i++) skg_free(block[i]);
    o->soft.links = 0;
}
