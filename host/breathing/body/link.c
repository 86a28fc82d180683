/* Links between organs: found by their labels and places. */
#include "body/build.h"

#include "body/bones.h"
#include "body/links.h"
#include "body/shares.h"
#include "core/threads.h"

/* The diaphragm comes first, since others take its share. */
static skg_status make_chains(skg_body *body) {
    static const skg_role deformable[] = {ROLE_DIAPHRAGM, ROLE_LINKED};
    for (int64_t i = 0; i < body->organs; i++) body->organ[i].coupled = skg_is_coupled(body, body->organ + i);
    body->diaphragm = -1;
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == ROLE_DIAPHRAGM && body->organ[i].coupled) body->diaphragm = (int32_t)i;
    for (size_t r = 0; r < sizeof deformable / sizeof *deformable; r++)
        for (int64_t i = 0; i < body->organs; i++)
            if (body->organ[i].role == deformable[r]) SKG_TRY(skg_body_make_chain(body, body->organ + i));
    for (int64_t i = 0; i < body->organs; i++) {
        if (body->organ[i].role == ROLE_SPANNED && body->organ[i].coupled)
            SKG_TRY(skg_share_find(body, body->organ + i));
        skg_liver_carries(body, body->organ + i);
    }
    return SKG_OK;
}

skg_status skg_body_share_again(skg_body *body) {
    static const skg_role followers[] = {ROLE_DIAPHRAGM, ROLE_LINKED, ROLE_SPANNED};
    for (size_t r = 0; r < sizeof followers / sizeof *followers; r++)
        for (int64_t i = 0; i < body->organs; i++) {
            skg_body_organ *o = body->organ + i;
            if (o->role == followers[r] && o->coupled) SKG_TRY(skg_share_again(body, o));
        }
    for (int64_t i = 0; i < body->organs; i++) skg_liver_carries(body, body->organ + i);
    return SKG_OK;
}

skg_status skg_body_find_links(skg_body *body) {
    SKG_TRY(skg_openmp_enter());
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
    SKG_TRY(skg_alloc(12 * body->organs, sizeof *body->bone_motion, "body", &body->bone_motion));
    return make_chains(body);
}

skg_status skg_body_find_links_again(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++) skg_body_drop_chain(body->organ + i);
    return make_chains(body);
}
