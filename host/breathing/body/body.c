/* A body as a handle. */
#include "body/types.h"
#include "core/context.h"

#include "body/bones.h"
#include "body/build.h"

#include "core/maths.h"
#include "core/text.h"
#include "core/threads.h"

#include <inttypes.h>
#include <string.h>

/* Vertices of deformable organs from which threads are used. With fewer, a step takes about a millisecond, and
 * threads that wait for work between steps take more from a device on the same cores than they give. */
enum { THREADS_FROM = 40000 };

void skg_body_options_init_sized(void *options, int32_t size) {
    const skg_body_options defaults = {.tendon_mm = {0, 0, -15},
                                       .muscle_length = 0.8,
                                       .rib_angle_rad = skg_rib_angle(),
                                       .liver_follows = 1,
                                       .liver_held = 0.25};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

static skg_status check_anatomy(const skg_body_options *o) {
    const struct {
        const char *name;
        double value, low, high;
    } all[] = {{"dome_left_mm", o->dome_left_mm, -57, 57}, {"dome_right_mm", o->dome_right_mm, -57, 57},
               {"dome_back_mm", o->dome_back_mm, -57, 57}, {"muscle_length", o->muscle_length, 0.1, 1},
               {"rib_angle_rad", o->rib_angle_rad, 0, 1},  {"rib_fall_rad", o->rib_fall_rad, -0.1, 0.1},
               {"liver_follows", o->liver_follows, 0, 2},  {"liver_held", o->liver_held, 0, 1}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!(all[i].value >= all[i].low && all[i].value <= all[i].high))
            return skg_fail(SKG_ERR_BREATHING, "body: %s is %g; the range is %g to %g", all[i].name,
                            all[i].value, all[i].low, all[i].high);
    return SKG_OK;
}

static skg_status check_options(const skg_body_options *o) {
    if (o->relaxation < 0 || o->relaxation > 20)
        return skg_fail(SKG_ERR_BREATHING, "body: %" PRId32 " relaxation passes; the range is 0 to 20",
                        o->relaxation);
    if (!skg_all_finite(o->tendon_mm, 3) || skg_length(o->tendon_mm) > 100)
        return skg_fail(SKG_ERR_BREATHING, "body: tendon_mm is (%g, %g, %g); its length is at most 100 mm",
                        o->tendon_mm[0], o->tendon_mm[1], o->tendon_mm[2]);
    if (!skg_all_finite(o->tendon_plane, 4))
        return skg_fail(SKG_ERR_BREATHING, "body: tendon_plane is not finite");
    if (!(o->reference_thoracic >= 0 && o->reference_thoracic <= 4 && o->reference_diaphragmatic >= 0 &&
          o->reference_diaphragmatic <= 4))
        return skg_fail(SKG_ERR_BREATHING, "body: reference weights are %g and %g; the range is 0 to 4",
                        o->reference_thoracic, o->reference_diaphragmatic);
    if (!(o->diaphragm_ribs_mm >= 0 && o->diaphragm_ribs_mm <= 1000 && o->diaphragm_liver_mm >= 0 &&
          o->diaphragm_liver_mm <= 1000))
        return skg_fail(
            SKG_ERR_BREATHING,
            "body: the diaphragm's links reach %g mm to ribs and %g mm to the liver; the range is 0 to 1000 mm",
            o->diaphragm_ribs_mm, o->diaphragm_liver_mm);
    SKG_TRY(check_anatomy(o));
    if (o->coupling != SKG_COUPLING_ANATOMICAL && o->coupling != SKG_COUPLING_PAPER)
        return skg_fail(SKG_ERR_BREATHING, "body: coupling is %" PRId32 "; one of SKG_COUPLING_",
                        o->coupling);
    if (!(o->hysteresis >= 0 && o->hysteresis <= 1))
        return skg_fail(SKG_ERR_BREATHING, "body: hysteresis is %g; the range is 0 to 1", o->hysteresis);
    return SKG_OK;
}

static skg_status create(skg_context *context, const skg_body_options *options, skg_body **result) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_body_create", result);
    *result = NULL;
    skg_body_options ours;
    skg_body_options_init(&ours);
    if (options) SKG_TRY(skg_struct_read(options, "skg_body_options", &ours, sizeof ours));
    SKG_TRY(check_options(&ours));
    SKG_TRY(skg_openmp_enter());
    skg_body *body;
    SKG_TRY(skg_alloc(1, sizeof *body, "body", &body));
    if (context) SKG_TRY(skg_context_retain(context));
    body->context = context;
    body->options = ours;
    *result = body;
    return SKG_OK;
}

skg_status skg_body_create(skg_context *context, const skg_body_options *options, skg_body **result) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, options, result));
}

static void free_organ(skg_body_organ *o) {
    skg_mesh_release(&o->mesh);
    skg_chain_free(&o->soft.chain);
    for (int64_t l = 0; l < o->soft.given_count; l++) {
        char *to = (char *)(uintptr_t)o->soft.given[l].to; /* our own copy */
        skg_free(&to);
    }
    skg_tree_free(&o->tree);
    skg_soft *soft = &o->soft;
    skg_coupling *coupling = &o->coupling;
    skg_carried *carried = &o->carried;
    void *block[] = {&o->label,         &o->rest,          &o->corner,           &o->node_of,
                     &o->moved,         &soft->link,       &soft->anchor,        &soft->given,
                     &soft->target,     &soft->state,      &soft->memory,        &coupling->share,
                     &coupling->beyond, &coupling->course, &coupling->bone,      &coupling->bone_weight,
                     &coupling->way,    &coupling->base,   &coupling->bone_base, &coupling->bone_away,
                     &coupling->thin,   &carried->near,    &carried->weight,     &carried->fraction};
    for (size_t i = 0; i < sizeof block / sizeof *block; i++) skg_free(block[i]);
}

void skg_body_release(skg_body **body) {
    if (!body || !*body) return;
    for (int64_t i = 0; i < (*body)->organs; i++) free_organ((*body)->organ + i);
    skg_free(&(*body)->organ);
    skg_free(&(*body)->loop_state);
    skg_free(&(*body)->bone_motion);
    skg_context_release(&(*body)->context);
    skg_free(body);
}

skg_status skg_body_add(skg_body *body, const skg_organ *organ, int64_t *id) {
    SKG_PLAIN;
    skg_organ ours;
    skg_organ_init(&ours);
    if (!body || body->linked)
        return skg_fail(SKG_ERR_BREATHING, "body: organs are added before skg_body_link");
    SKG_TRY(skg_struct_read(organ, "skg_organ", &ours, sizeof ours));
    if (!ours.mesh || !ours.label)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_body_add: the organ has no mesh or no label");
    if (ours.inside < -1 || ours.inside >= body->organs)
        return skg_fail(SKG_ERR_BREATHING, "%s: inside organ %" PRId64 ", which was not added before it",
                        ours.label, ours.inside);
    if (body->organs == body->capacity) {
        int64_t capacity = 2 * body->capacity + 16;
        SKG_TRY(skg_realloc(capacity, sizeof *body->organ, "body", &body->organ));
        body->capacity = capacity;
    }
    skg_body_organ *o = body->organ + body->organs;
    memset(o, 0, sizeof *o);
    skg_status status = skg_body_fill_organ(&ours, o);
    if (status != SKG_OK) {
        free_organ(o);
        return status;
    }
    if (id) *id = body->organs;
    body->organs++;
    return SKG_OK;
}

skg_status skg_body_link(skg_body *body) {
    SKG_PLAIN;
    if (!body || body->tried) return skg_fail(SKG_ERR_BREATHING, "body: skg_body_link is called once");
    int moves = 0;
    for (int64_t i = 0; i < body->organs; i++) moves |= body->organ[i].role != ROLE_STATIC;
    if (!moves)
        return skg_fail(
            SKG_ERR_BREATHING,
            "body: there is no organ that moves; labels such as \"rib 5 left\" or \"liver\" have rules");
    body->tried = 1;
    SKG_TRY(skg_body_find_links(body));
    int64_t deformable = 0;
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].soft.chain && body->organ[i].role == ROLE_LINKED)
            deformable += body->organ[i].vertices;
    body->large = deformable >= THREADS_FROM;
    body->linked = 1;
    return SKG_OK;
}

skg_status skg_body_needle_set(skg_body *body, double withdrawn_mm) {
    SKG_PLAIN;
    if (!body || !isfinite(withdrawn_mm) || fabs(withdrawn_mm) > 1000)
        return skg_fail(SKG_ERR_BREATHING, "body: the needle is withdrawn by %g mm; at most 1000 mm",
                        withdrawn_mm);
    body->withdrawn = withdrawn_mm;
    return SKG_OK;
}
