/* Posing: each organ after those that it follows. */
#include "body/bones.h"
#include "body/links.h"
#include "body/posed.h"
#include "body/shares.h"
#include "core/maths.h"
#include "core/text.h"
#include "core/threads.h"

#include <string.h>

static void pose_rigid(skg_body_organ *o) {
    for (int64_t i = 0; i < o->vertices; i++)
        skg_rigid_displace(&o->rigid, o->rest + 3 * i, o->moved + 3 * i);
}

/* Turns an organ about its head, by its rotation vector times a factor. */
static void pose_turn(skg_body_organ *o, double factor) {
    double vector[3];
    skg_scale_vector(factor, o->turn.axis, vector);
    skg_rotation(vector, o->rigid.rotation);
    memcpy(o->rigid.centre, o->turn.head, sizeof o->turn.head);
    memset(o->rigid.shift, 0, sizeof o->rigid.shift);
    pose_rigid(o);
}

/* The sternum follows the anterior ends of the true ribs, 1 to 7: their vertices farthest from the head. */
static void fit_sternum(const skg_body *body, int moves, skg_rigid *rigid) {
    enum { TRUE_RIBS = 7, ENDS = 2 * TRUE_RIBS };
    double points[ENDS][3], displacements[ENDS][3];
    int64_t count = 0;
    for (int64_t r = 0; r < body->organs && count < ENDS; r++) {
        const skg_body_organ *o = body->organ + r;
        if (o->role != ROLE_RIB || o->number > TRUE_RIBS) continue;
        double most = -1, d[3];
        for (int64_t i = 0; i < o->vertices; i++) {
            skg_add_scaled(o->rest + 3 * i, -1, o->turn.head, d);
            if (skg_dot(d, d) <= most) continue;
            most = skg_dot(d, d);
            memcpy(points[count], o->rest + 3 * i, sizeof points[0]);
            memcpy(displacements[count], o->moved + 3 * i, sizeof displacements[0]);
        }
        count++;
    }
    memset(rigid, 0, sizeof *rigid);
    for (int k = 0; k < 3; k++) rigid->rotation[4 * k] = 1;
    if (moves && count >= 3) /* fewer points leave the rotation open */
        skg_rigid_fit(count, points[0], displacements[0], rigid);
}

static void pose_cartilage(const skg_body *body, skg_body_organ *o) {
    const skg_rigid *from = &body->organ[o->carried.near[0]].rigid,
                    *to = &body->organ[o->carried.near[1]].rigid;
    for (int64_t i = 0; i < o->vertices; i++) {
        double a[3], b[3];
        skg_rigid_displace(from, o->rest + 3 * i, a);
        skg_rigid_displace(to, o->rest + 3 * i, b);
        for (int k = 0; k < 3; k++)
            o->moved[3 * i + k] = (1 - o->carried.fraction[i]) * a[k] + o->carried.fraction[i] * b[k];
    }
}

/* Fraction of the way to the mean of its neighbours that a node goes in one pass (a choice). */
static const double relaxed_by = 0.5;

/* Times that facets are opened and links kept again, at most. */
enum { UNFOLDINGS = 8 };

/* A facet of a chain that would fold is opened, even where bones drive its corners: by some tenths of a mm. Links are kept
 * last. */
static skg_status unfold_chain(skg_body_organ *o) {
    skg_chain_report report;
    for (int round = 0; round < UNFOLDINGS && skg_thin_open(o, 1); round++) {
        SKG_TRY(skg_chain_settle(o->soft.chain, o->moved, &report));
        if (report.conflict_mm == 0) break;
    }
    for (int64_t i = 0; i < o->vertices; i++)
        if (o->node_of[i] != i)
            memcpy(o->moved + 3 * i, o->moved + 3 * (int64_t)o->node_of[i], 3 * sizeof(double));
    return SKG_OK;
}

static skg_status pose_chain(skg_body *body, skg_body_organ *o) {
    skg_soft *soft = &o->soft;
    const double blend = body->options.hysteresis;
    const int64_t nodes = soft->chain->nodes;
    skg_rigid motion;
    for (int64_t d = 0; d < soft->links; d++) skg_link_follow(body, soft->link + d, soft->target + 3 * d);
    const int turns = soft->corotates && skg_corotate_motion(o, &motion);
    for (int64_t d = 0; turns && d < soft->links; d++)
        skg_corotate_remove(&motion, soft->anchor + 3 * d, soft->target + 3 * d, soft->target + 3 * d);
    memset(soft->state, 0, (size_t)(3 * nodes) * sizeof(double));
    SKG_TRY(skg_chain_move(soft->chain, soft->target, soft->state, &soft->report));
    if (body->options.relaxation > 0)
        SKG_TRY(skg_chain_relax(soft->chain, body->options.relaxation, relaxed_by, soft->state));
    if (blend > 0) SKG_TRY(skg_chain_move(soft->chain, soft->target, soft->memory, &soft->report));
    for (int64_t i = 0; i < o->vertices; i++) {
        double *moved = o->moved + 3 * i;
        for (int k = 0; k < 3; k++) {
            const int64_t at = k * nodes + o->node_of[i];
            moved[k] = soft->state[at];
            if (blend > 0) moved[k] += blend * (soft->memory[at] - moved[k]);
        }
    }
    if (soft->unfolds) SKG_TRY(unfold_chain(o));
    for (int64_t i = 0; i < o->vertices && turns; i++)
        skg_corotate_restore(&motion, o->rest + 3 * i, o->moved + 3 * i, o->moved + 3 * i);
    return SKG_OK;
}

/* Puts the tip where its tissue is, turns the axis through the place where the needle enters the skin, and draws it
 * back. */
static void pose_needle(const skg_body *body, skg_body_organ *o) {
    double tip[3], skin[3], rest[3], now[3], turn[3], at[3];
    skg_link_follow(body, &o->needle.skin, skin);
    int64_t nearest = 0;
    for (int64_t i = 0; i < o->vertices; i++)
        if (memcmp(o->rest + 3 * i, o->needle.tip, sizeof o->needle.tip) == 0) nearest = i;
    skg_carried_vertex(body, o, nearest, tip);
    skg_add_scaled(o->needle.pivot, -1, o->needle.tip, rest);
    for (int k = 0; k < 3; k++) now[k] = rest[k] + skin[k] - tip[k];
    skg_scale_vector(1 / skg_length(rest), rest, rest);
    skg_scale_vector(1 / skg_length(now), now, now);
    skg_cross(rest, now, turn);
    double sine = skg_length(turn);
    if (sine > 0) skg_scale_vector(atan2(sine, skg_dot(rest, now)) / sine, turn, turn);
    skg_rotation(turn, o->rigid.rotation);
    memcpy(o->rigid.centre, o->needle.tip, sizeof o->needle.tip);
    skg_scale_vector(body->withdrawn, now, at);
    for (int k = 0; k < 3; k++) o->rigid.shift[k] = tip[k] + at[k];
    pose_rigid(o);
}

/* Links are kept last. Where the wish breaks some, facets that are not thin may fold too: then both are done again, as
 * long as facets fold. */
static skg_status pose_coupled(const skg_body *body, skg_body_organ *o) {
    skg_chain_report last;
    skg_share_displace(body, o);
    skg_thin_open(o, 0);
    if (o->soft.chain) SKG_TRY(skg_chain_settle(o->soft.chain, o->moved, &o->soft.report));
    last = o->soft.report;
    for (int round = 1; round < UNFOLDINGS && last.conflict_mm > 0 && skg_thin_open(o, 1); round++) {
        SKG_TRY(skg_chain_settle(o->soft.chain, o->moved, &last));
        if (last.conflict_mm > o->soft.report.conflict_mm) o->soft.report = last;
    }
    for (int64_t i = 0; i < o->vertices; i++)
        if (o->node_of[i] != i)
            memcpy(o->moved + 3 * i, o->moved + 3 * (int64_t)o->node_of[i], 3 * sizeof(double));
    return SKG_OK;
}

static skg_status pose_one(skg_body *body, skg_body_organ *o) {
    switch (o->role) {
    case ROLE_ENCLOSED:
        o->rigid = body->organ[o->inside].rigid;
        pose_rigid(o);
        return SKG_OK;
    case ROLE_CARTILAGE:
        pose_cartilage(body, o);
        return SKG_OK;
    case ROLE_DIAPHRAGM:
    case ROLE_LINKED:
        return o->coupled ? pose_coupled(body, o) : pose_chain(body, o);
    case ROLE_CARRIED:
    case ROLE_SPANNED:
        if (o->coupled) return pose_coupled(body, o);
        for (int64_t i = 0; i < o->vertices; i++) skg_carried_vertex(body, o, i, o->moved + 3 * i);
        return SKG_OK;
    case ROLE_NEEDLE:
        pose_needle(body, o);
        return SKG_OK;
    default:
        return SKG_OK;
    }
}

/* Writes an organ's positions into its mesh, as floats where the upload reads them. At rest the file's own positions
 * return. */
static skg_status write_mesh(skg_body_organ *o) {
    int64_t at_rest = 0;
    int differs = 0;
    while (at_rest < 3 * o->vertices && o->moved[at_rest] == 0) at_rest++;
    if (at_rest == 3 * o->vertices) {
        if (!o->changed) return SKG_OK;
        o->changed = 0;
        return skg_mesh_positions_set(o->mesh, o->rest, 0);
    }
    float *offsets;
    const double *origin;
    SKG_TRY(skg_mesh_offsets_get(o->mesh, &offsets, &origin));
    for (int64_t i = 0; i < o->vertices; i++)
        for (int k = 0; k < 3; k++) {
            float offset = (float)(o->rest[3 * i + k] - origin[k] + o->moved[3 * i + k]);
            differs |= offset != offsets[3 * i + k];
            offsets[3 * i + k] = offset;
        }
    o->changed = 1;
    return differs ? skg_mesh_offsets_moved(o->mesh) : SKG_OK;
}

static int is_of(const skg_body_organ *o, skg_role role, int stage) {
    return o->role == role && o->soft.stage == stage;
}

/* Organs of one role and stage do not follow each other, so that their order does not matter. */
static skg_status pose_role(skg_body *body, skg_role role, int stage) {
    skg_status status = SKG_OK;
#pragma omp parallel for schedule(dynamic, 1) if (role == ROLE_LINKED && body->large)
    for (int64_t i = 0; i < body->organs; i++) {
        if (!is_of(body->organ + i, role, stage)) continue;
        skg_status one = pose_one(body, body->organ + i);
#pragma omp critical(skg_body_status)
        if (one != SKG_OK) status = one;
    }
    if (status == SKG_ERR_BREATHING)
        return skg_fail(status,
                        "body: a driven point of an organ is not finite; check the meshes and the breath");
    return status;
}

/* Bones turn by a fraction of their rotation at full inspiration, or by the caller's rotation times the weight. */
static void pose_bones(skg_body *body, double thoracic) {
    const double from = body->options.reference_thoracic;
    const double fraction = skg_rib_fraction(thoracic) - skg_rib_fraction(from);
    skg_rigid sternum;
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        if (o->role == ROLE_RIB || o->role == ROLE_RIGID || o->turn.given)
            pose_turn(o, o->turn.given ? thoracic - from : fraction * skg_rib_factor(&body->options, o));
    }
    fit_sternum(body, thoracic != from, &sternum);
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        if (o->role != ROLE_STERNUM || o->turn.given) continue;
        o->rigid = sternum;
        pose_rigid(o);
    }
    skg_wall_prepare(body);
}

/* Poses all organs, without writing their meshes. */
static skg_status pose_all(skg_body *body, double thoracic, double diaphragmatic) {
    const skg_body_options *options = &body->options;
    int stages = 0;
    body->descended = diaphragmatic - options->reference_diaphragmatic;
    skg_scale_vector(body->descended, options->tendon_mm, body->tendon);
    for (int64_t i = 0; i < body->organs; i++)
        stages = body->organ[i].soft.stage > stages ? body->organ[i].soft.stage : stages;
    pose_bones(body, thoracic);
    SKG_TRY(pose_role(body, ROLE_CARTILAGE, 0));
    SKG_TRY(pose_role(body, ROLE_ENCLOSED, 0));
    for (int stage = 0; stage <= stages; stage++) {
        SKG_TRY(pose_role(body, ROLE_DIAPHRAGM, stage));
        SKG_TRY(pose_role(body, ROLE_LINKED, stage));
    }
    static const skg_role followers[] = {ROLE_CARRIED, ROLE_SPANNED, ROLE_NEEDLE};
    for (size_t r = 0; r < sizeof followers / sizeof *followers; r++)
        SKG_TRY(pose_role(body, followers[r], 0));
    return SKG_OK;
}

/* Copies the memories of all chains to a step of the loop (out 1) or from it. */
static void copy_memories(skg_body *body, int step, int out) {
    double *at = body->loop_state + step * body->loop_size;
    for (int64_t i = 0; i < body->organs; i++) {
        skg_body_organ *o = body->organ + i;
        if (!o->soft.memory) continue;
        size_t size = (size_t)(3 * o->soft.chain->nodes) * sizeof(double);
        memcpy(out ? at : o->soft.memory, out ? o->soft.memory : at, size);
        at += 3 * o->soft.chain->nodes;
    }
}

skg_status skg_body_breathe(skg_body *body, const skg_breath *breath) {
    SKG_PLAIN;
    if (!body || !body->linked) return skg_fail(SKG_ERR_BREATHING, "body: call skg_body_link first");
    SKG_TRY(skg_breath_check(breath));
    body->loop = 0, body->loop_size = 0;
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].soft.memory) {
            body->loop_size += 3 * body->organ[i].soft.chain->nodes;
            memset(body->organ[i].soft.memory, 0,
                   (size_t)(3 * body->organ[i].soft.chain->nodes) * sizeof(double));
        }
    SKG_TRY(skg_realloc(LOOP_STEPS * body->loop_size, sizeof(double), "breathing loop", &body->loop_state));
    for (int cycle = 0; cycle < 2; cycle++) /* the state is periodic from the second cycle on */
        for (int step = 0; step < LOOP_STEPS; step++) {
            skg_breath_state state;
            skg_breath_state_init(&state);
            SKG_TRY(skg_breath_state_at_phase(breath, (double)step / LOOP_STEPS, &state));
            SKG_TRY(pose_all(body, state.thoracic, state.diaphragmatic));
            copy_memories(body, step, 1);
        }
    body->loop = LOOP_STEPS;
    return SKG_OK;
}

skg_status skg_body_pose(skg_body *body, const skg_breath_state *theirs) {
    SKG_PLAIN;
    skg_breath_state state;
    skg_breath_state_init(&state);
    if (!body || !body->linked) return skg_fail(SKG_ERR_BREATHING, "body: call skg_body_link first");
    SKG_TRY(skg_openmp_enter());
    SKG_TRY(skg_struct_read(theirs, "skg_breath_state", &state, sizeof state));
    if (!(state.thoracic >= 0 && state.thoracic <= 4 && state.diaphragmatic >= 0 &&
          state.diaphragmatic <= 4 && state.phase >= 0 && state.phase < 1))
        return skg_fail(SKG_ERR_BREATHING,
                        "body: phase %g with weights %g and %g; the phase is 0 to below 1, a weight 0 to 4",
                        state.phase, state.thoracic, state.diaphragmatic);
    if (body->options.hysteresis > 0) {
        if (!body->loop)
            return skg_fail(SKG_ERR_BREATHING, "body: hysteresis needs a call of skg_body_breathe first");
        copy_memories(body, (int)(state.phase * LOOP_STEPS) % LOOP_STEPS, 0);
    }
    SKG_TRY(pose_all(body, state.thoracic, state.diaphragmatic));
    for (int64_t i = 0; i < body->organs; i++) SKG_TRY(write_mesh(body->organ + i));
    skg_body_warn_conflicts(body);
    return SKG_OK;
}
