/* Whether another place agrees as well: from a result whose model lacks something, the search is repeated from both sides of the least certain
 * direction. */
#include "registration/types.h"

#include <string.h>

/* How far apart two poses are: what moves most of the points on the axes of the world at the body's radius. */
static double distance_between(const skg_registration *r, const double *a, const double *b) {
    double most = 0;
    for (int k = 0; k < 6; k++) {
        double point[3], from[3], to[3];
        memcpy(point, r->middle, sizeof point);
        point[k % 3] += k < 3 ? r->radius : -r->radius;
        skg_pose_point(a, point, from);
        skg_pose_point(b, point, to);
        skg_add_scaled(to, -1, from, to);
        most = fmax(most, skg_length(to));
    }
    return most;
}

/* Searches from one side. A lower loss is taken; an almost equal one elsewhere is told. */
static skg_status probe_side(skg_registration *r, double length, reg_state *state, double *loss) {
    const reg_level *last = &r->levels[r->level_count - 1];
    double step[REG_POSE], other = HUGE_VAL;
    reg_state_copy(r, &r->state, state);
    skg_scale_vector(length, r->least, step);
    skg_scale_vector(length, r->least + 3, step + 3);
    reg_state_move(r, step, state);
    SKG_TRY(reg_search(r, last, state, &other));
    const double apart = distance_between(r, r->state.motion, state->motion);
    if (apart <= r->options.need_mm) {
        if (other < *loss) reg_state_copy(r, state, &r->state);
        *loss = fmin(*loss, other);
        return SKG_OK;
    }
    if (other < (1 + REG_SAME) * *loss && other > (1 - REG_SAME) * *loss) r->apart = fmax(r->apart, apart);
    if (other >= *loss) return SKG_OK;
    *loss = other;
    reg_state_copy(r, state, &r->state);
    return SKG_OK;
}

skg_status reg_probe(skg_registration *r) {
    const double length = fmax(5 * r->options.need_mm, 5 * r->directions[0].sigma_structure_mm);
    double loss = r->result.loss;
    reg_state state = {0};
    skg_status status = SKG_OK;
    if (r->options.free != SKG_REGISTRATION_FREE_POSE ||
        r->result.verdict != SKG_REGISTRATION_VERDICT_STRUCTURE)
        return SKG_OK;
    r->loss = r->minimized;
    r->apart = 0;
    SKG_TRY_CLEANUP(reg_state_create(r, &state));
    for (int side = -1; side <= 1; side += 2) SKG_TRY_CLEANUP(probe_side(r, side * length, &state, &loss));
    status = reg_judge(r);
cleanup:
    reg_state_free(&state);
    return status;
}
