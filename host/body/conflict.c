/* Drivers that pull against each other: which organs they are. */
#include "body/body.h"

#include "core/vector.h"

static const double told_from_mm = 1;

static const char *driver_name(const skg_body *body, const skg_link *link) {
    if (link->organ == LINK_TENDON) return "tendon";
    return link->organ < 0 ? "spine" : body->organ[link->organ].label;
}

/* The driver that is overrun most, and the one that overruns it: farther from it than the links between them
 * allow. One search from it over the state at rest, lifted so that no gain that matters is below 0. */
void skg_conflict_partners(const skg_body *body, const skg_body_organ *o, const char *between[2]) {
    skg_chain *chain = o->chain;
    const skg_chain_report *report = &o->report;
    const int axis = report->axis;
    between[0] = between[1] = NULL;
    if (!(report->conflict_mm > 0) || report->driver < 0) return;
    double most = 0, lift = 0, *rest;
    int64_t partner = report->driver;
    if (skg_alloc(chain->nodes, sizeof *rest, o->label, &rest) != SKG_OK) return;
    for (int64_t d = 0; d < o->links; d++) lift = fmax(lift, 2 * fabs(o->target[3 * d + axis]));
    for (int direction = 1; direction >= -1; direction -= 2) {
        skg_chain_front *front = chain->front + axis;
        const double from = direction * o->target[3 * report->driver + axis];
        skg_chain_forget(front);
        skg_chain_start(front, chain->driver[report->driver], lift + from);
        skg_chain_spread(chain, axis, direction, rest, front);
        for (int64_t d = 0; d < o->links; d++) {
            const double over = front->gain[chain->driver[d]] - lift - direction * o->target[3 * d + axis];
            if (over > most) most = over, partner = d;
        }
    }
    skg_chain_forget(chain->front + axis);
    skg_free(&rest);
    between[0] = driver_name(body, o->link + report->driver);
    between[1] = driver_name(body, o->link + partner);
}

void skg_body_tell_conflicts(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        const char *between[2];
        if (!o->chain || o->told || !(o->report.conflict_mm > told_from_mm)) continue;
        skg_conflict_partners(body, o, between);
        if (!between[0]) continue;
        o->told = 1;
        skg_log(
            body->context, SKG_LOG_WARNING,
            "%s: %s and %s%s ask for %.1f mm more along %c than its tissue allows, and meet halfway; breathe "
            "less deeply, or give it a softer tissue or other links",
            o->label, between[0], between[0] == between[1] ? "another place of " : "", between[1],
            o->report.conflict_mm, "xyz"[o->report.axis]);
    }
}
