/* Makes the machine of a recipe: buffers, kernels, and what does not move. */
#include "beam/counter_kernels.h"
#include "core/maths.h"
#include "frame/plans.h"
#include "plan/decisions.h"

#include <string.h>

static skg_status find_planes(const skg_mesh *mesh, skg_mesh_layout *layout) {
    int32_t planes[SKG_MESH_PLANES][3];
    layout->plane_count = skg_mesh_flat_faces(mesh, planes);
    layout->flat = layout->plane_count > 0;
    if (!layout->flat) return SKG_OK;
    SKG_TRY(skg_alloc(layout->plane_count, sizeof *layout->planes, "flat faces", &layout->planes));
    memcpy(layout->planes, planes, (size_t)layout->plane_count * sizeof *planes);
    return SKG_OK;
}

/* Marks the meshes with flat faces where at least two parts have one. */
static skg_status find_flat(const skg_recipe *recipe, skg_mesh_layout *layouts) {
    const skg_plan_meshes *meshes = &recipe->meshes;
    int64_t parts = 0;
    for (int64_t i = 0; recipe->scene->count > 1 && i < meshes->count; i++)
        SKG_TRY(find_planes(meshes->meshes[i], &layouts[i]));
    for (int64_t p = 0; p < recipe->scene->count; p++) parts += layouts[meshes->of_part[p]].flat;
    for (int64_t i = 0; parts < 2 && i < meshes->count; i++) layouts[i].flat = 0;
    return SKG_OK;
}

static skg_status make_geometry(const skg_recipe *recipe, skg_machine *machine) {
    const skg_plan_meshes *meshes = &recipe->meshes;
    skg_mesh_layout *layouts = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(meshes->count, sizeof *layouts, "meshes", &layouts));
    for (int64_t i = 0; i < meshes->count && status == SKG_OK; i++)
        status = skg_mesh_layout_create(meshes->meshes[i], &layouts[i]);
    if (status == SKG_OK) status = find_flat(recipe, layouts);
    if (status == SKG_OK)
        status = skg_geometry_create(machine->context, skg_recipe_kernel_precision(recipe), meshes->count,
                                     layouts, recipe->scene->count, meshes->of_part, &machine->geometry);
    for (int64_t i = 0; i < meshes->count; i++) skg_mesh_layout_release(&layouts[i]);
    skg_free(&layouts);
    return status;
}

static skg_status make_pulses(const skg_recipe *recipe, skg_machine *machine) {
    const skg_counting *counting = &recipe->options.counter->counting;
    const double dead = counting->pile_up ? counting->dead_time_ns * 1e-9 / counting->exposure_s : 0;
    skg_counter_kernels kernels;
    SKG_TRY(skg_counter_kernels_make(recipe->options.counter, recipe->spectrum, &kernels));
    const skg_status status =
        skg_pulses_create(machine->context, &kernels, counting->pile_up, dead, &machine->pulses);
    skg_counter_kernels_release(&kernels);
    return status;
}

static skg_status make_detector(const skg_recipe *recipe, const skg_plan_options *options,
                                skg_machine *machine) {
    const double pixel_mm[2] = {skg_length(recipe->view.column_step), skg_length(recipe->view.row_step)};
    skg_layers *layers = &machine->layers;
    skg_detection detection;
    double factors[SKG_CHANNELS_MAX];
    int32_t wanted = 0;
    SKG_TRY(skg_layers_create(machine->context, options->blur, options->depth_blur, layers));
    if (recipe->options.dqe && recipe->options.noise)
        SKG_TRY(skg_layers_add_noise(machine->context, options->blur, recipe->options.dqe, pixel_mm, layers));
    if (options->counter) SKG_TRY(make_pulses(recipe, machine));
    SKG_TRY(skg_decide_detection(recipe, &detection, factors, &wanted));
    return wanted ? skg_detector_create(machine->context, &detection, factors, &machine->detector) : SKG_OK;
}

static skg_status make_attenuation(const skg_recipe *recipe, skg_context *context, skg_attenuation *images) {
    const skg_model *model = &recipe->model;
    const skg_attenuation_tables tables = {model->coefficients, model->weights, model->variances,
                                           model->range};
    skg_attenuation shape;
    skg_decide_attenuation(recipe, &shape);
    return skg_attenuation_create(context, recipe->options.precision, &shape, &tables, images);
}

static skg_status make_lengths(const skg_recipe *recipe, skg_machine *machine) {
    const double one = 1;
    const skg_attenuation_tables tables = {.coefficients = &one, .weights = &one};
    const skg_attenuation length = {
        .planes = 1, .nodes = 1, .channels = 1, .layers = 1, .shown = SKG_SHOW_EXPONENT, .world_plane = -1};
    return skg_attenuation_create(machine->context, recipe->options.precision, &length, &tables,
                                  &machine->lengths);
}

skg_status skg_machine_assemble(skg_context *context, const skg_recipe *recipe,
                                const skg_plan_options *options, skg_machine *machine) {
    machine->context = machine->rasters.context = context;
    SKG_TRY(skg_volumes_create(context, recipe->scene, &machine->volumes));
    SKG_TRY(make_geometry(recipe, machine));
    SKG_TRY(make_detector(recipe, options, machine));
    SKG_TRY(make_lengths(recipe, machine));
    SKG_TRY(skg_attenuator_create(context, &machine->attenuator));
    SKG_TRY(
        skg_buffer_reserve(context, &machine->negative, 4 * sizeof(cl_int), CL_MEM_READ_WRITE, "counters"));
    SKG_TRY(skg_leaky_memory_create(context, recipe->leaky_count, &machine->leaky));
    SKG_TRY(skg_pass_memory_create(recipe->scene->count, skg_recipe_max_fine(recipe) * recipe->view.columns,
                                   skg_recipe_max_fine(recipe) * recipe->view.rows, &machine->pass));
    machine->pass.placement = &machine->placement;
    machine->pass.geometry = &machine->geometry;
    machine->pass.volumes = &machine->volumes;
    return SKG_OK;
}

skg_status skg_machine_complete(const skg_recipe *recipe, skg_machine *machine) {
    SKG_TRY(skg_volumes_weigh(machine->context, recipe->scene, &recipe->model, &machine->volumes));
    return make_attenuation(recipe, machine->context, &machine->images);
}

skg_status skg_machine_renew(const skg_recipe *recipe, skg_machine *machine) {
    skg_attenuation images = {0};
    SKG_TRY(skg_volumes_weigh(machine->context, recipe->scene, &recipe->model, &machine->volumes));
    const skg_status status = make_attenuation(recipe, machine->context, &images);
    if (status != SKG_OK) {
        skg_attenuation_release(&images);
        return status;
    }
    /* OpenCL keeps the old tables until what is enqueued is done. */
    skg_attenuation_release(&machine->images);
    machine->images = images;
    machine->flat_field.known = 0;
    return SKG_OK;
}
