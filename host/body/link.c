#include "body/link.h"

#include "body/carry.h"
#include "body/chains.h"
#include "body/ribs.h"
#include "body/rules.h"
#include "body/tie.h"

static skg_status make_chains(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == ROLE_DIAPHRAGM || body->organ[i].role == ROLE_LINKED)
            SKG_TRY(skg_body_make_chain(body, body->organ + i));
    return SKG_OK;
}

skg_status skg_body_find_links(skg_body *body) {
    skg_body_set_tendon_plane(body);
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == ROLE_RIB) SKG_TRY(skg_rib_prepare(body, body->organ + i));
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        if (o->role == ROLE_CARTILAGE) SKG_TRY(skg_carry_cartilage(body, o));
        if (o->role == ROLE_CARRIED || o->role == ROLE_SPANNED || o->role == ROLE_NEEDLE)
            SKG_TRY(skg_carry_follow(body, o));
        if (o->role == ROLE_STATIC) SKG_TRY(skg_carry_adopt(body, o));
    }
    SKG_TRY(skg_body_check_ties(body));
    return make_chains(body);
}

skg_status skg_body_find_links_again(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++) skg_body_drop_chain(body->organ + i);
    return make_chains(body);
}
