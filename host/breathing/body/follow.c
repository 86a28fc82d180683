/* Where a linked vertex goes with the organ that it follows. */
#include "body/links.h"

#include "body/shares.h"
#include "core/maths.h"

#include <string.h>

void skg_link_follow(const skg_body *body, const skg_link *link, double displacement[3]) {
    memset(displacement, 0, 3 * sizeof *displacement);
    if (link->organ == LINK_TENDON) memcpy(displacement, body->tendon, sizeof body->tendon);
    if (link->organ < 0) return;
    const skg_body_organ *o = body->organ + link->organ;
    if (link->fixed) {
        skg_rigid_displace(&o->rigid, link->point, displacement);
        return;
    }
    for (int c = 0; c < 3; c++)
        skg_add_scaled(displacement, link->fraction * link->weight[c], o->moved + 3 * link->corner[c],
                       displacement);
}

void skg_carried_vertex(const skg_body *body, const skg_body_organ *o, int64_t i, double displacement[3]) {
    memset(displacement, 0, 3 * sizeof *displacement);
    if (o->carried.by == LINK_TENDON) {
        double centre[3], motion[3];
        for (int k = 0; k < 3; k++) centre[k] = 0.5 * (o->bounds[k] + o->bounds[3 + k]);
        skg_dome_motion(body, centre, motion);
        skg_scale_vector(body->descended, motion, displacement);
    }
    for (int n = 0; o->carried.by >= 0 && n < CARRIERS; n++)
        skg_add_scaled(displacement, o->carried.weight[CARRIERS * i + n],
                       body->organ[o->carried.by].moved + 3 * o->carried.near[CARRIERS * i + n],
                       displacement);
    if (o->coupling.beyond)
        skg_add_scaled(displacement, body->descended, o->coupling.beyond + 3 * i, displacement);
    if (o->carried.fraction) skg_scale_vector(o->carried.fraction[i], displacement, displacement);
}
