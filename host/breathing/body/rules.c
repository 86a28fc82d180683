/* The rules by which the links of two organs are chosen. */
#include "body/links.h"

#include "body/shares.h"
#include "core/maths.h"

/* Distances in mm below are choices. Reaches are a few mm more than the gaps that lie between organs. */

/* The nearest point of the organs with a role and a range of numbers, and its distance. */
static double nearest_of(const skg_body *body, skg_role role, int first, int last, const double p[3],
                         double reach, skg_link *link) {
    double least = HUGE_VAL;
    for (int64_t o = 0; o < body->organs; o++) {
        const skg_body_organ *organ = body->organ + o;
        if (organ->role != role || organ->number < first || organ->number > last) continue;
        skg_link found = {.fraction = 1};
        double d = skg_nearest(organ, p, fmin(reach, least), &found);
        if (d < least) least = d, *link = found, link->organ = (int32_t)o;
    }
    return least;
}

double skg_diaphragm_ribs_reach(const skg_body_options *options) {
    return options->diaphragm_ribs_mm > 0 ? options->diaphragm_ribs_mm : 16;
}

double skg_diaphragm_liver_reach(const skg_body_options *options) {
    return options->diaphragm_liver_mm > 0 ? options->diaphragm_liver_mm : 9;
}

/* Above 0 in the tendon. */
static double plane_value(const skg_body *body, const double p[3]) {
    return skg_dot(body->options.tendon_plane, p) + body->options.tendon_plane[3];
}

/* The tendon is driven. The lowest tenth of the muscle follows ribs 6 to 12 where they are near, or stays beside the
 * spine. */
static int diaphragm_rule(const skg_body *body, const skg_body_organ *organ, const double p[3],
                          skg_link *link) {
    const double *bounds = organ->bounds;
    *link = (skg_link){.organ = LINK_TENDON, .fraction = 1};
    if (plane_value(body, p) > 0) return 1;
    const double rib_reach = skg_diaphragm_ribs_reach(&body->options), spine_reach = 12;
    if (p[2] > bounds[2] + 0.1 * (bounds[5] - bounds[2])) return 0;
    if (nearest_of(body, ROLE_RIB, 6, 12, p, rib_reach, link) < HUGE_VAL) return 1;
    *link = (skg_link){.organ = LINK_STAYS};
    for (int64_t o = 0; o < body->organs; o++) {
        skg_link spine;
        if (skg_label_stays(body->organ[o].label) &&
            skg_nearest(body->organ + o, p, spine_reach, &spine) < HUGE_VAL)
            return 1;
    }
    return 0;
}

/* The base follows the diaphragm, the upper wall the ribs. Between them, where the wall is near the diaphragm too,
 * the lung slides. */
static int lung_rule(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link) {
    const double reach = 16, slides_within = 45;
    (void)organ;
    double to_base = nearest_of(body, ROLE_DIAPHRAGM, 0, 0, p, slides_within, link);
    if (to_base < reach) return 1;
    return to_base == HUGE_VAL && nearest_of(body, ROLE_RIB, 2, 7, p, reach, link) < HUGE_VAL;
}

/* Liver, heart and others: what lies under or on the tendon follows it. */
static int tendon_rule(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link) {
    const int is_liver = skg_label_begins(organ->label, "liver");
    const double reach = is_liver ? skg_diaphragm_liver_reach(&body->options) : 9;
    if (nearest_of(body, ROLE_DIAPHRAGM, 0, 0, p, reach, link) == HUGE_VAL) return 0;
    const skg_body_organ *diaphragm = body->organ + link->organ;
    int tendon = 1;
    for (int c = 0; c < 3; c++)
        tendon &= diaphragm->coupled
                      ? diaphragm->coupling.share[diaphragm->node_of[link->corner[c]]] >= skg_dome_from
                      : plane_value(body, diaphragm->rest + 3 * link->corner[c]) > 0;
    return tendon;
}

/* Skin over the ribs' fat, and the muscle under it, follow them: fully up to `near`, then the less the farther away, and not at all from `far`
 * on. */
static int skin_rule(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link) {
    const double near = 22, far = 60;
    skg_link sternum;
    (void)organ;
    double to_rib = nearest_of(body, ROLE_RIB, 1, 10, p, far, link);
    double to_sternum = nearest_of(body, ROLE_STERNUM, 0, 0, p, fmin(to_rib, far), &sternum);
    if (to_sternum < to_rib) *link = sternum;
    double least = fmin(to_rib, to_sternum);
    link->fraction = fmin(1, (far - least) / (far - near));
    return least < far;
}

/* Cartilage grows on the ends of ribs and on the edge of the sternum. */
static int cartilage_rule(const skg_body *body, const skg_body_organ *organ, const double p[3],
                          skg_link *link) {
    const double reach = 5; /* a joint and half a bone's thickness */
    skg_link sternum;
    (void)organ;
    double to_rib = nearest_of(body, ROLE_RIB, 1, 10, p, reach, link);
    double to_sternum = nearest_of(body, ROLE_STERNUM, 0, 0, p, fmin(to_rib, reach), &sternum);
    if (to_sternum < to_rib) *link = sternum;
    if (fmin(to_rib, to_sternum) == HUGE_VAL) return 0;
    skg_link_fix(body, p, link);
    return 1;
}

skg_link_rule skg_link_rule_of(const skg_body_organ *organ) {
    if (organ->role == ROLE_DIAPHRAGM) return diaphragm_rule;
    if (skg_label_begins(organ->label, "lung")) return lung_rule;
    if (skg_label_begins(organ->label, "cartilage")) return cartilage_rule;
    return skg_label_is_wall(organ->label) ? skin_rule : tendon_rule;
}

void skg_body_set_tendon_plane(skg_body *body) {
    double *plane = body->options.tendon_plane;
    int32_t d = skg_find_organ(body, "diaphragm");
    body->plane_given = plane[0] != 0 || plane[1] != 0 || plane[2] != 0;
    if (d < 0 || body->plane_given) return;
    const double *b = body->organ[d].bounds;
    /* At the middle of its depth, 0.3 of the diaphragm's height below its top. Tilted by 45 degrees so that the steep
     * front is muscle. The height and the tilt are choices. */
    plane[1] = 1, plane[2] = 1;
    plane[3] = -0.5 * (b[1] + b[4]) - (b[5] - 0.3 * (b[5] - b[2]));
}
