/* Scenes and frames that have no derivatives are refused by name, before anything is computed. */
#include "gradient/refusals.h"

#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"

#include <inttypes.h>

static skg_status check_wanted(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                               const skg_gradient *wanted) {
    const skg_plan_options *options = &recipe->options;
    const skg_plan_meshes *meshes = &recipe->meshes;
    double factors[SKG_CHANNELS_MAX];
    skg_detection detection;
    int32_t detects = 0;
    if (options->precision == SKG_PRECISION_HALF)
        return skg_effect_no_gradient(call, "precision half", "take single or double");
    SKG_TRY(skg_effects_check_gradient(call, recipe, wanted->source || wanted->detector));
    for (int64_t m = 0; m < meshes->count; m++)
        if (skg_placement_of(&machine->placement, meshes->meshes[m], m))
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: positions of %s were set on the device, where gradients do not find them; set them "
                "with skg_mesh_positions_set",
                call, meshes->meshes[m]->name);
    SKG_TRY(skg_decide_detection(recipe, &detection, factors, &detects));
    if (detects && detection.over_flat_field)
        return skg_effect_no_gradient(
            call, "a ratio to a flat field that differs from pixel to pixel, with noise, steps or a blur",
            "make the plan without them");
    if (wanted->attenuations && machine->images.ratio)
        return skg_effect_no_gradient(
            call, "a ratio to a flat field that differs from ray to ray, under attenuation coefficients,",
            "make the plan of energies or photons");
    return SKG_OK;
}

/* Cells have no derivatives by their own places. */
static skg_status check_volumes(const char *call, const skg_scene *scene, const skg_gradient *wanted) {
    for (int64_t p = 0; p < scene->count && scene->volumes > 0; p++) {
        if (!scene->parts[p].volume) continue;
        if (wanted->vertices && wanted->vertices[p])
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: %s is a volume of cells, and has no vertices of its own", call,
                            scene->parts[p].label);
    }
    return SKG_OK;
}

skg_status skg_gradient_check_cells(const char *call, const skg_scene *scene,
                                    const skg_direction *direction) {
    const double *poses = direction->poses, *attenuations = direction->attenuations;
    for (int64_t p = 0; p < scene->count && scene->volumes > 0; p++) {
        int moves = direction->vertices && direction->vertices[p], changes = 0;
        if (!scene->parts[p].volume) continue;
        for (int k = 0; k < 6 && poses; k++) moves |= poses[6 * p + k] != 0;
        for (int64_t n = 0; n < direction->nodes && attenuations; n++)
            changes |= attenuations[p * direction->nodes + n] != 0;
        if (changes)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: %s is a volume of cells, which have no common attenuation coefficient; change its density, or "
                "give it as a mesh",
                call, scene->parts[p].label);
        if (moves)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: %s is a volume of cells, and images have no derivative by its place; move the other "
                "parts, or give it as a mesh",
                call, scene->parts[p].label);
    }
    return SKG_OK;
}

/* Densities of parts that are filled in part have no gradient. */
static skg_status check_frame(const char *call, const skg_frame *frame, const skg_gradient *wanted) {
    skg_frame ours;
    skg_frame_init(&ours);
    if (!frame) return SKG_OK;
    SKG_TRY(skg_struct_read(frame, "skg_frame", &ours, sizeof ours));
    if (wanted->densities && ours.fill_fractions)
        return skg_effect_no_gradient(call, "a density beside fill fractions", "leave one of the two out");
    return SKG_OK;
}

/* Materials that were changed may have other energies, which the caller's memory has no place for. */
static skg_status check_nodes(const char *call, int64_t count, const void *attenuations, int64_t given) {
    if (!attenuations || given == count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: the attenuations have memory for %" PRId64 " energies, and the plan has %" PRId64
                    "; set `nodes` to what skg_plan_node_count says now",
                    call, given, count);
}

skg_status skg_gradient_check(const char *call, const skg_plan *plan, const skg_frame *frame,
                              const skg_gradient *wanted) {
    SKG_TRY(check_wanted(call, plan->recipe, &plan->machine, wanted));
    SKG_TRY(check_volumes(call, plan->recipe->scene, wanted));
    SKG_TRY(check_nodes(call, plan->recipe->model.nodes, wanted->attenuations, wanted->nodes));
    return check_frame(call, frame, wanted);
}
