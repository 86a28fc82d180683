/* What has no derivatives is refused by name, before anything is computed. */
#include "gradient/refusals.h"

#include "core/text.h"
#include "geometry/optics.h"
#include "plan/decisions.h"

#include <inttypes.h>

skg_status skg_gradient_refuse(const char *call, const char *what, const char *mend) {
    return skg_fail(SKG_ERR_UNSUPPORTED, "%s: %s has no gradient; %s", call, what, mend);
}

/* Source and detector. */
static skg_status check_view(const char *call, const skg_recipe *recipe) {
    static const char mend[] = "take it of poses, vertices or densities alone, or leave the effect out";
    const skg_plan_options *options = &recipe->options;
    if (options->heel) return skg_gradient_refuse(call, "the heel effect under source and detector", mend);
    if (options->bowtie) return skg_gradient_refuse(call, "a bow-tie filter under source and detector", mend);
    if (options->grid)
        return skg_gradient_refuse(call, "an anti-scatter grid under source and detector", mend);
    if (options->oblique)
        return skg_gradient_refuse(call, "an oblique scintillator under source and detector", mend);
    if (skg_collimation_limits(options->collimation))
        return skg_gradient_refuse(call, "a collimator under source and detector", mend);
    if (options->world && skg_quantity_is_ratio(options))
        return skg_gradient_refuse(call, "a ratio to the flat field of a world under source and detector",
                                   mend);
    if (options->world && recipe->view.projection == SKG_PROJECTION_PARALLEL)
        return skg_gradient_refuse(call, "a world in a parallel beam under source and detector", mend);
    return SKG_OK;
}

static skg_status check_wanted(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                               const skg_gradient *wanted) {
    const skg_plan_options *options = &recipe->options;
    const skg_plan_meshes *meshes = &recipe->meshes;
    double factors[SKG_CHANNELS_MAX];
    skg_detection detection;
    int32_t detects = 0;
    if (options->precision == SKG_PRECISION_HALF)
        return skg_gradient_refuse(call, "precision half", "take single or double");
    if (options->scatter) return skg_gradient_refuse(call, "scatter", "make the plan without it");
    if (options->unite)
        return skg_gradient_refuse(call, "the union of components",
                                   "make the plan without unite, of meshes that do not overlap");
    if (recipe->leaky_count)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: the mesh of part %s is not closed, and its repair has no gradient; close the mesh", call,
            recipe->scene->parts[recipe->leaky[0]].label);
    for (int64_t m = 0; m < meshes->count; m++)
        if (skg_placement_of(&machine->placement, meshes->meshes[m], m))
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: positions of %s were set on the device, where gradients do not find them; set them "
                "with skg_mesh_positions_set",
                call, meshes->meshes[m]->name);
    SKG_TRY(skg_decide_detection(recipe, &detection, factors, &detects));
    if (detects && detection.over_flat_field)
        return skg_gradient_refuse(
            call, "a ratio to a flat field that differs from pixel to pixel, with noise or steps",
            "make the plan without noise and steps");
    if (wanted->attenuations && machine->images.ratio)
        return skg_gradient_refuse(
            call, "a ratio to a flat field that differs from ray to ray, under attenuation coefficients,",
            "make the plan of energies or photons");
    return wanted->source || wanted->detector ? check_view(call, recipe) : SKG_OK;
}

/* Densities of parts that are filled in part have no gradient. */
static skg_status check_frame(const char *call, const skg_frame *frame, const skg_gradient *wanted) {
    skg_frame ours;
    skg_frame_init(&ours);
    if (!frame) return SKG_OK;
    SKG_TRY(skg_struct_read(frame, "skg_frame", &ours, sizeof ours));
    if (wanted->densities && ours.fill_fractions)
        return skg_gradient_refuse(call, "a density beside fill fractions", "leave one of the two out");
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
    SKG_TRY(check_nodes(call, plan->recipe->model.nodes, wanted->attenuations, wanted->nodes));
    return check_frame(call, frame, wanted);
}
