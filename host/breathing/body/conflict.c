/* Finds points that links pull two ways at once, and warns of them. */
#include "body/posed.h"

#include "core/maths.h"

static const double warned_from_mm = 1; /* a choice */

static const char *driver_name(const skg_body *body, const skg_link *link) {
    if (link->organ == LINK_TENDON) return "tendon";
    return link->organ < 0 ? "spine" : body->organ[link->organ].label;
}

/* The driver that is overrun most, and the one that overruns it: the two are farther apart than the links between
 * them allow. A search from the first over the state at rest finds what the links allow; all targets are lifted by
 * the same amount, so that gains are above 0. */
void skg_conflict_partners(const skg_body *body, const skg_body_organ *o, const char *between[2]) {
    skg_chain *chain = o->soft.chain;
    const skg_chain_report *report = &o->soft.report;
    const int axis = report->axis;
    between[0] = between[1] = NULL;
    if (!(report->conflict_mm > 0) || report->driver < 0) return;
    double most = 0, lift = 0, *rest;
    int64_t partner = report->driver;
    if (skg_alloc(chain->nodes, sizeof *rest, o->label, &rest) != SKG_OK) return;
    for (int64_t d = 0; d < o->soft.links; d++) lift = fmax(lift, 2 * fabs(o->soft.target[3 * d + axis]));
    for (int direction = 1; direction >= -1; direction -= 2) {
        skg_chain_front *front = chain->front + axis;
        const double from = direction * o->soft.target[3 * report->driver + axis];
        skg_chain_forget(front);
        skg_chain_start(front, chain->driver[report->driver], lift + from);
        skg_chain_spread(chain, axis, direction, rest, front);
        for (int64_t d = 0; d < o->soft.links; d++) {
            const double over =
                front->gain[chain->driver[d]] - lift - direction * o->soft.target[3 * d + axis];
            if (over > most) most = over, partner = d;
        }
    }
    skg_chain_forget(chain->front + axis);
    skg_free(&rest);
    between[0] = driver_name(body, o->soft.link + report->driver);
    between[1] = driver_name(body, o->soft.link + partner);
}

void skg_body_warn_conflicts(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        const char *between[2];
        if (!o->soft.chain || o->warned || !(o->soft.report.conflict_mm > warned_from_mm)) continue;
        skg_conflict_partners(body, o, between);
        if (!between[0] && !o->coupled) continue;
        o->warned = 1;
        if (o->coupled) {
            skg_log(
                body->context, SKG_LOG_WARNING,
                "%s: ribs and diaphragm deform it along %c by more than its tissue allows; it departs from them by "
                "up to %.1f mm. Breathe less deeply, or give it a softer tissue.",
                o->label, "xyz"[o->soft.report.axis], 0.5 * o -> soft.report.conflict_mm);
            continue;
        }
        skg_log(
            body->context, SKG_LOG_WARNING,
            "%s: along %c, the displacements of %s and %s%s differ by %.1f mm more than its tissue allows; they "
            "meet halfway. Breathe less deeply, or give it a softer tissue or other links.",
            o->label, "xyz"[o->soft.report.axis], between[0],
            between[0] == between[1] ? "another place of " : "", between[1], o->soft.report.conflict_mm);
    }
}
