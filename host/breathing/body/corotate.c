/* Takes the common rotation out of a motion before Chain Mail, and puts it back. */
#include "body/posed.h"

#include "core/eigen.h"
#include "core/maths.h"

int skg_corotates(const skg_body *body, const skg_body_organ *o) {
    double mean[3] = {0}, scatter[9] = {0}, values[3], axes[9];
    for (int64_t d = 0; d < o->soft.links; d++) {
        const skg_link *link = o->soft.link + d;
        if (link->organ < 0 || link->fraction < 1) return 0;
        const skg_role role = body->organ[link->organ].role;
        if (role != ROLE_RIB && role != ROLE_STERNUM && role != ROLE_CARTILAGE && role != ROLE_RIGID)
            return 0;
        skg_add_scaled(mean, 1 / (double)o->soft.links, o->soft.anchor + 3 * d, mean);
    }
    for (int64_t d = 0; d < o->soft.links; d++)
        for (int k = 0; k < 9; k++)
            scatter[k] +=
                (o->soft.anchor[3 * d + k / 3] - mean[k / 3]) * (o->soft.anchor[3 * d + k % 3] - mean[k % 3]);
    skg_eigen(3, scatter, values, axes);
    /* Drivers that are about 1 mm off a line (1 mm2 each in the second eigenvalue) determine a rotation. */
    return o->soft.links >= 3 && values[1] > (double)o->soft.links;
}

int skg_corotate_motion(const skg_body_organ *o, skg_rigid *motion) {
    int moves = 0;
    for (int64_t k = 0; k < 3 * o->soft.links; k++) moves |= o->soft.target[k] != 0;
    if (moves) skg_rigid_fit(o->soft.links, o->soft.anchor, o->soft.target, motion);
    return moves;
}

void skg_corotate_remove(const skg_rigid *f, const double rest[3], const double u[3], double v[3]) {
    double p[3];
    for (int k = 0; k < 3; k++) p[k] = rest[k] - f->centre[k] + (u[k] - f->shift[k]);
    for (int k = 0; k < 3; k++)
        v[k] = f->rotation[k] * p[0] + f->rotation[3 + k] * p[1] + f->rotation[6 + k] * p[2] -
               (rest[k] - f->centre[k]);
}

void skg_corotate_restore(const skg_rigid *f, const double rest[3], const double v[3], double u[3]) {
    double p[3], d[3];
    skg_add_scaled(rest, 1, v, p);
    skg_rigid_displace(f, p, d);
    skg_add_scaled(v, 1, d, u);
}
