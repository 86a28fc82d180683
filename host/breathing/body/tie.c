/* Ties that the caller gives between organs, checked and made. */
#include "body/links.h"

#include "core/maths.h"

#include <ctype.h>
#include <string.h>

static int same_label(const char *a, const char *b) {
    for (; *a && *b; a++, b++)
        if (tolower((unsigned char)*a) != tolower((unsigned char)*b)) return 0;
    return *a == *b;
}

/* Whether a link leads to an organ: "rib 5 left" to that organ, "rib" to each whose label begins so. */
static int leads_to(const skg_body *body, const char *to, const skg_body_organ *other) {
    if (same_label(other->label, to)) return 1;
    for (int64_t i = 0; i < body->organs; i++)
        if (same_label(body->organ[i].label, to)) return 0;
    return skg_label_begins(other->label, to);
}

static int is_deformable(const skg_body_organ *o) {
    return o->role == ROLE_DIAPHRAGM || o->role == ROLE_LINKED;
}

static skg_status check_tie(const skg_body *body, const skg_body_organ *o, const char *to) {
    int found = 0;
    for (int64_t i = 0; i < body->organs; i++) {
        const skg_body_organ *other = body->organ + i;
        if (other == o || !leads_to(body, to, other)) continue;
        found = 1;
        if (other->role == ROLE_CARRIED || other->role == ROLE_SPANNED || other->role == ROLE_NEEDLE)
            return skg_fail(SKG_ERR_BREATHING,
                            "%s: linked to %s, which itself follows another organ; link it to that one",
                            o->label, other->label);
    }
    if (found) return SKG_OK;
    return skg_fail(SKG_ERR_BREATHING, "%s: linked to \"%s\", but no other organ's label begins so", o->label,
                    to);
}

static int depends(const skg_body *body, const skg_body_organ *o, const skg_body_organ *other) {
    if (other == o || !is_deformable(other)) return 0;
    if (o->soft.given_count == 0) return o->role != ROLE_DIAPHRAGM && other->role == ROLE_DIAPHRAGM;
    for (int64_t l = 0; l < o->soft.given_count; l++)
        if (leads_to(body, o->soft.given[l].to, other)) return 1;
    return 0;
}

void skg_link_fix(const skg_body *body, const double p[3], skg_link *link) {
    const skg_role role = body->organ[link->organ].role;
    link->fixed = role == ROLE_RIB || role == ROLE_STERNUM || role == ROLE_RIGID;
    memcpy(link->point, p, sizeof link->point);
}

skg_status skg_body_check_ties(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++)
        for (int64_t l = 0; l < body->organ[i].soft.given_count; l++)
            SKG_TRY(check_tie(body, body->organ + i, body->organ[i].soft.given[l].to));
    for (int rises = 1;
         rises;) { /* the stage of an organ is the length of the longest chain of organs that it follows */
        rises = 0;
        for (int64_t i = 0; i < body->organs; i++)
            for (int64_t j = 0; j < body->organs; j++) {
                skg_body_organ *o = body->organ + i;
                const skg_body_organ *other = body->organ + j;
                if (!is_deformable(o) || !depends(body, o, other) || o->soft.stage > other->soft.stage)
                    continue;
                o->soft.stage = other->soft.stage + 1, rises = 1;
                if (o->soft.stage > body->organs)
                    return skg_fail(SKG_ERR_BREATHING,
                                    "%s: linked to %s, which is linked back to it; remove one of the links",
                                    o->label, other->label);
            }
    }
    return SKG_OK;
}

double skg_given_link(const skg_body *body, const skg_body_organ *o, const double p[3], skg_link *link,
                      double *rigid) {
    double least = HUGE_VAL;
    for (int64_t l = 0; l < o->soft.given_count; l++)
        for (int64_t i = 0; i < body->organs; i++) {
            skg_link found = {.organ = (int32_t)i, .fraction = 1};
            if (body->organ + i == o || !leads_to(body, o->soft.given[l].to, body->organ + i)) continue;
            double d = skg_nearest(body->organ + i, p, fmin(o->soft.given[l].distance_mm, least), &found);
            if (d < least) least = d, *link = found, *rigid = o->soft.given[l].rigid_mm;
        }
    return least;
}
