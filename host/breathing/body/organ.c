/* Adds organs to a body, and checks what the caller says of them. */
#include "body/build.h"

#include "body/bones.h"
#include "core/maths.h"

#include <inttypes.h>
#include <string.h>

void skg_organ_init_sized(void *organ, int32_t size) {
    const skg_organ defaults = {.inside = -1, .centre_mm = {(double)NAN, (double)NAN, (double)NAN}};
    skg_struct_init(organ, size, &defaults, sizeof defaults);
}

void skg_organ_link_init_sized(void *link, int32_t size) {
    const skg_organ_link defaults = {0};
    skg_struct_init(link, size, &defaults, sizeof defaults);
}

/* The rotation vector at weight 1. With x to the left and y to the back, the front is raised by a rotation about -x,
 * and the side by one about -y on the left and about y on the right. */
static skg_status take_turn(const skg_organ *given, skg_body_organ *o) {
    if (!skg_all_finite(given->turn_rad, 3) || !(skg_length(given->turn_rad) <= SKG_PI) ||
        !(fabs(given->gamma_rad) <= SKG_PI) || !(fabs(given->lambda_rad) <= SKG_PI))
        return skg_fail(SKG_ERR_BREATHING, "%s: its rotation is not finite, or more than half a turn",
                        o->label);
    const double paper[3] = {-given->lambda_rad, (o->side < 0 ? 1 : -1) * given->gamma_rad, 0};
    skg_add_scaled(given->turn_rad, 1, paper, o->turn.axis);
    o->turn.given = skg_length(o->turn.axis) > 0;
    const int has_rule = o->role == ROLE_RIB || o->role == ROLE_STERNUM;
    if (!o->turn.given && !has_rule)
        return skg_fail(
            SKG_ERR_BREATHING,
            "%s: rigid, but its label has no rule; give it a rotation (an axis and an angle, or gamma "
            "and lambda)",
            o->label);
    if (!has_rule) o->role = ROLE_RIGID;
    return SKG_OK;
}

static skg_status take_kind(const skg_organ *given, skg_body_organ *o) {
    const int turns = skg_length(given->turn_rad) != 0 || given->gamma_rad != 0 || given->lambda_rad != 0;
    o->kind = given->kind;
    if (given->kind < SKG_ORGAN_BY_LABEL || given->kind > SKG_ORGAN_DEFORMABLE)
        return skg_fail(SKG_ERR_BREATHING, "%s: kind %" PRId32 "; one of SKG_ORGAN_", o->label, given->kind);
    if (turns && given->kind != SKG_ORGAN_RIGID)
        return skg_fail(SKG_ERR_BREATHING, "%s: has a rotation, but is not rigid; give it that kind",
                        o->label);
    if (given->kind == SKG_ORGAN_STATIC) o->role = ROLE_STATIC;
    if (given->kind == SKG_ORGAN_DEFORMABLE && o->role != ROLE_DIAPHRAGM) o->role = ROLE_LINKED;
    return given->kind == SKG_ORGAN_RIGID ? take_turn(given, o) : SKG_OK;
}

static skg_status take_links(const skg_organ *given, skg_body_organ *o) {
    if (given->link_count < 0 || (given->link_count > 0 && !given->links))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " links at NULL", o->label, given->link_count);
    if (given->link_count > 0 && o->role != ROLE_LINKED && o->role != ROLE_DIAPHRAGM)
        return skg_fail(SKG_ERR_BREATHING, "%s: has links, but is not deformable; give it that kind",
                        o->label);
    SKG_TRY(skg_alloc(given->link_count, sizeof *o->soft.given, o->label, &o->soft.given));
    for (int64_t l = 0; l < given->link_count; l++) {
        skg_organ_link from;
        skg_organ_link_init(&from);
        SKG_TRY(skg_struct_read_at(given->links, l, "skg_organ_link", &from, sizeof from));
        char *to = NULL;
        if (!from.to) return skg_fail(SKG_ERR_ARGUMENT, "%s: link %" PRId64 " to NULL", o->label, l);
        if (!(from.distance_mm > 0 && from.distance_mm <= 1000 && from.rigid_mm >= 0 &&
              from.rigid_mm <= from.distance_mm))
            return skg_fail(
                SKG_ERR_BREATHING,
                "%s: a link to %s within %g mm, rigid within %g mm; a link reaches above 0 to 1000 mm, and is rigid "
                "no farther than that",
                o->label, from.to, from.distance_mm, from.rigid_mm);
        SKG_TRY(skg_copy_text(from.to, &to));
        o->soft.given[l] = from;
        o->soft.given[l].to = to;
        o->soft.given_count = l + 1;
    }
    return SKG_OK;
}

/* The centre of the rotation. That of a rib is found with its axis, unless the caller gives one. */
static skg_status take_centre(const skg_organ *given, skg_body_organ *o) {
    double axes[9];
    int known = 0;
    for (int k = 0; k < 3; k++) known += !isnan(given->centre_mm[k]);
    if (known > 0 && (o->kind != SKG_ORGAN_RIGID || !skg_all_finite(given->centre_mm, 3)))
        return skg_fail(SKG_ERR_BREATHING,
                        "%s: a centre of rotation needs three finite numbers and a rigid organ", o->label);
    o->turn.centred = known > 0;
    if (known > 0)
        memcpy(o->turn.head, given->centre_mm, sizeof o->turn.head);
    else if (o->turn.given && o->role != ROLE_RIB)
        skg_inertia_axes(o, axes, o->turn.head);
    return SKG_OK;
}

skg_status skg_body_fill_organ(const skg_organ *given, skg_body_organ *o) {
    SKG_TRY(skg_mesh_retain(given->mesh));
    o->mesh = given->mesh;
    SKG_TRY(skg_copy_text(given->label, &o->label));
    o->inside = given->inside;
    o->role = skg_role_of(o->label, &o->number, &o->side);
    SKG_TRY(take_kind(given, o));
    SKG_TRY(take_links(given, o));
    o->tissue_by_label = given->alpha_min == 0 && given->alpha_max == 0 && given->beta == 0;
    o->tissue = o->tissue_by_label ? skg_tissue_of(o->label)
                                   : (skg_tissue){given->alpha_min, given->alpha_max, given->beta};
    SKG_TRY(skg_mesh_count(o->mesh, &o->vertices, &o->triangles));
    SKG_TRY(skg_alloc(3 * o->vertices, sizeof(double), o->label, &o->rest));
    SKG_TRY(skg_alloc(3 * o->vertices, sizeof(double), o->label, &o->moved));
    SKG_TRY(skg_alloc(3 * o->triangles, sizeof(int32_t), o->label, &o->corner));
    SKG_TRY(skg_alloc(o->vertices, sizeof(int32_t), o->label, &o->node_of));
    SKG_TRY(skg_mesh_positions_get(o->mesh, o->rest, 0));
    SKG_TRY(skg_mesh_triangles_get(o->mesh, o->corner, 0));
    for (int64_t i = 0; i < o->vertices; i++) {
        if (!skg_all_finite(o->rest + 3 * i, 3))
            return skg_fail(SKG_ERR_BREATHING, "%s: vertex %" PRId64 " is not finite", o->label, i);
        for (int k = 0; k < 3; k++) {
            o->bounds[k] = i == 0 ? o->rest[k] : fmin(o->bounds[k], o->rest[3 * i + k]);
            o->bounds[3 + k] = i == 0 ? o->rest[k] : fmax(o->bounds[3 + k], o->rest[3 * i + k]);
        }
        o->node_of[i] = o->mesh->weld ? o->mesh->weld[i] : (int32_t)i;
    }
    SKG_TRY(skg_tree_create(o->label, o->rest, o->triangles, o->corner, &o->tree));
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    SKG_TRY(skg_mesh_health_get(o->mesh, &health));
    o->volume = health.volume;
    return take_centre(given, o);
}
