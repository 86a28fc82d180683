#include "frame/plan.h"
#include "beam/spectrum.h"
#include "frame/frame.h"
#include "plan/report.h"

#include <inttypes.h>
#include <string.h>

void skg_plan_options_init(skg_plan_options *options) {
    if (options)
        *options = (skg_plan_options){.size = (int32_t)sizeof *options,
                                      .precision = SKG_PRECISION_SINGLE,
                                      .overlaps = 1,
                                      .supersampling = 1,
                                      .swank = 1,
                                      .repair = SKG_REPAIR_NEIGHBOURS};
}

static skg_status check_options(const skg_context *context, const skg_plan_options *options) {
    if (options->precision < SKG_PRECISION_SINGLE || options->precision > SKG_PRECISION_HALF)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "precision %" PRId32
                        " is unknown; SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE or SKG_PRECISION_HALF",
                        options->precision);
    if (options->precision == SKG_PRECISION_DOUBLE && !context->device->info.has_double)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s has no fp64, so precision double cannot be had there; take single",
                        context->device->info.name);
    if (options->strategy < SKG_STRATEGY_AUTO || options->strategy > SKG_STRATEGY_ATOMICS)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "strategy %" PRId32 " is unknown; SKG_STRATEGY_AUTO, _COPIES, _TILES or "
                        "_ATOMICS",
                        options->strategy);
    if (options->quantity < SKG_QUANTITY_ENERGY || options->quantity > SKG_QUANTITY_ATTENUATION)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "quantity %" PRId32 " is unknown; SKG_QUANTITY_ENERGY to SKG_QUANTITY_ATTENUATION",
                        options->quantity);
    if (options->falloff != 0 && options->falloff != 1)
        return skg_fail(SKG_ERR_ARGUMENT, "falloff is %" PRId32 "; 1 or 0", options->falloff);
    if (!(options->tolerance >= 0 && options->tolerance < 1))
        return skg_fail(SKG_ERR_ARGUMENT, "a tolerance of %g; a relative error from 0 to below 1",
                        options->tolerance);
    if (options->repair < SKG_REPAIR_NONE || options->repair > SKG_REPAIR_EXACT)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "repair %" PRId32 " is unknown; SKG_REPAIR_NONE, _NEIGHBOURS or _EXACT",
                        options->repair);
    if (options->clip != 0 && options->clip != 1)
        return skg_fail(SKG_ERR_ARGUMENT, "clip is %" PRId32 "; 1 or 0", options->clip);
    if (options->tile < 0 || options->tile > 32768)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a tile of %" PRId32 " pixels is not usable; 0 lets the plan choose", options->tile);
    return skg_plan_check_detector(options);
}

static void start_report(skg_plan *plan) {
    skg_plan_report *report = &plan->report;
    skg_plan_report_init(report);
    report->precision = plan->options.precision;
    report->quantity = plan->options.quantity;
    report->parts = plan->scene->count;
    for (int64_t i = 0; i < plan->scene->count; i++)
        report->triangles += plan->scene->parts[i].mesh->triangles;
    for (int64_t i = 0; i < plan->meshes.count; i++)
        report->vertices += plan->meshes.meshes[i].mesh->vertices;
    report->leaky_parts = plan->open_count;
    report->planes = plan->model.planes;
    report->accumulators = plan->mixed ? plan->mixed : plan->model.planes;
    report->nodes = plan->model.nodes;
    report->bins = plan->model.bins;
    report->bound = plan->model.bound;
    report->verified = plan->model.verified;
    report->strategy = plan->strategy;
}

/* Closed parts share planes; open ones are listed. Parts that do not show are neither. */
static skg_status find_open(skg_plan *plan) {
    SKG_TRY(skg_alloc(plan->scene->count, sizeof *plan->open, "open parts", &plan->open));
    for (int64_t i = 0; i < plan->scene->count; i++)
        if (!plan->scene->parts[i].mesh->closed) plan->open[plan->open_count++] = i;
    return SKG_OK;
}

static skg_status make_geometry(skg_plan *plan) {
    const skg_plan_meshes *meshes = &plan->meshes;
    skg_geometry_mesh *list = NULL;
    int32_t **sorted = NULL; /* [meshes] corners in an order for the device */
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(meshes->count, sizeof *list, "meshes", &list));
    SKG_TRY_CLEANUP(skg_alloc(meshes->count, sizeof *sorted, "meshes", &sorted));
    for (int64_t i = 0; i < meshes->count; i++) {
        const skg_mesh *mesh = meshes->meshes[i].mesh;
        int32_t reordered = 0;
        SKG_TRY_CLEANUP(skg_alloc(3 * mesh->triangles, sizeof **sorted, "corners", &sorted[i]));
        SKG_TRY_CLEANUP(skg_mesh_sorted_corners(mesh, sorted[i], &reordered));
        list[i] = (skg_geometry_mesh){mesh->vertices, mesh->triangles, sorted[i]};
    }
    SKG_TRY_CLEANUP(skg_geometry_create(
        plan->context,
        plan->options.precision == SKG_PRECISION_DOUBLE ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
        meshes->count, list, plan->scene->count, meshes->of_part, &plan->geometry));
cleanup:
    for (int64_t i = 0; sorted && i < meshes->count; i++) skg_free(&sorted[i]);
    skg_free(&sorted);
    skg_free(&list);
    return status;
}

static skg_status make_attenuation(skg_plan *plan) {
    const skg_model *model = &plan->model;
    /* The attenuation of one energy is the exponent itself. */
    const int is_ratio = skg_quantity_is_ratio(&plan->options) && !skg_quantity_is_absolute(&plan->options);
    const int32_t shown = plan->options.quantity != SKG_QUANTITY_ATTENUATION || skg_plan_is_late(plan)
                              ? SKG_SHOWN_INTENSITY
                          : model->nodes == 1 ? SKG_SHOWN_EXPONENT
                                              : SKG_SHOWN_LOGARITHM;
    /* Over one energy's open beam the world cancels. */
    const int has_world = model->world_plane >= 0 && !(is_ratio && model->nodes == 1);
    const skg_attenuation image = {.planes = model->planes,
                                   .nodes = model->nodes,
                                   .channels = model->channels,
                                   .shown = shown,
                                   .world_plane = has_world ? (int32_t)model->world_plane : -1,
                                   .world_weight = model->world_weight,
                                   .ratio = has_world && is_ratio,
                                   .falloff = plan->options.falloff && !is_ratio,
                                   .noise = plan->options.noise,
                                   .energies = plan->options.quantity == SKG_QUANTITY_ENERGY};
    const skg_attenuation_tables tables = {model->coefficients, model->weights, model->variances,
                                           model->range};
    return skg_attenuation_create(plan->context, plan->options.precision, &image, &tables,
                                  &plan->attenuation);
}

static skg_status make_lengths(skg_plan *plan) {
    const double one = 1;
    const skg_attenuation_tables tables = {.coefficients = &one, .weights = &one};
    const skg_attenuation length = {
        .planes = 1, .nodes = 1, .channels = 1, .shown = SKG_SHOWN_EXPONENT, .world_plane = -1};
    SKG_TRY(skg_attenuation_create(plan->context, plan->options.precision, &length, &tables, &plan->lengths));
    SKG_TRY(skg_attenuator_create(plan->context, &plan->attenuator));
    SKG_TRY(skg_buffer_reserve(plan->context, &plan->negative, 2 * sizeof(cl_int), CL_MEM_READ_WRITE,
                               "counters"));
    return skg_buffer_reserve(plan->context, &plan->bad,
                              plan->open_count * (1 + SKG_FIRST_BAD) * (int64_t)sizeof(cl_int),
                              CL_MEM_READ_WRITE, "bad pixels");
}

static skg_status make_samples(skg_plan *plan) {
    const int parallel = plan->view.projection != SKG_PROJECTION_POINT;
    SKG_TRY(
        skg_samples_make(parallel ? NULL : plan->options.spot, plan->options.supersampling, &plan->samples));
    plan->options.spot = NULL; /* the caller's, and copied */
    return SKG_OK;
}

skg_status skg_plan_renew_model(skg_plan *plan) {
    skg_model model;
    if (plan->materials == plan->scene->materials) return SKG_OK;
    if (plan->model.bound > 0)
        return skg_fail(SKG_STALE,
                        "a material has changed, and the plan's %d energies were chosen for the old ones; "
                        "make a new plan",
                        (int)plan->model.nodes);
    skg_status status = skg_model_create(plan->scene, &plan->view, plan->spectrum, &plan->options, &model);
    if (status != SKG_OK) {
        skg_model_release(&model);
        return status;
    }
    skg_model_release(&plan->model);
    plan->model = model;
    plan->report.planes = model.planes;
    /* OpenCL keeps the old tables until what is enqueued is done. */
    skg_attenuation_release(&plan->attenuation);
    SKG_TRY(make_attenuation(plan));
    plan->field.known = 0;
    SKG_TRY(skg_plan_choose_mix(plan));
    plan->report.accumulators = plan->mixed ? plan->mixed : plan->model.planes;
    plan->materials = plan->scene->materials;
    return SKG_OK;
}

/* What the paper's buffers could not hold is not offered in them. */
static skg_status check_half(const skg_plan *plan) {
    if (plan->options.precision != SKG_PRECISION_HALF) return SKG_OK;
    if (plan->view.projection != SKG_PROJECTION_POINT || plan->open_count > 0 || plan->options.world ||
        plan->priority_possible || plan->options.blur || skg_quantity_is_absolute(&plan->options))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "precision half is for comparison: a point source or samples of one, closed meshes without "
            "priorities, vacuum around them, no noise or blur; take single");
    return SKG_OK;
}

static skg_status make(skg_plan *plan) {
    SKG_TRY(skg_plan_meshes_create(plan->scene, &plan->meshes));
    SKG_TRY(skg_plan_meshes_check(&plan->meshes, plan->scene));
    SKG_TRY(skg_model_create(plan->scene, &plan->view, plan->spectrum, &plan->options, &plan->model));
    SKG_TRY(skg_plan_name_channels(plan));
    SKG_TRY(make_samples(plan));
    SKG_TRY(find_open(plan));
    plan->priority_possible = skg_priority_possible(plan->scene, plan->options.clip);
    SKG_TRY(check_half(plan));
    SKG_TRY(make_geometry(plan));
    SKG_TRY(skg_plan_make_detector(plan));
    SKG_TRY(make_attenuation(plan));
    SKG_TRY(make_lengths(plan));
    SKG_TRY(skg_scale_grid_create(plan->view.columns, plan->view.rows, &plan->grid));
    SKG_TRY(skg_plan_choose_mix(plan));
    SKG_TRY(skg_plan_choose_strategy(plan));
    start_report(plan);
    SKG_TRY(skg_report_overlaps(plan));
    SKG_TRY(skg_frame_prepare(plan));
    SKG_TRY(skg_plan_find_samples(plan));
    return skg_report_effects(plan);
}

enum { MOST_VIEWS = 1024 };

static skg_status keep_views(skg_plan *plan) {
    skg_plan_options *options = &plan->options;
    const skg_view *given = options->views;
    if (options->view_count < 0 || options->view_count > MOST_VIEWS || (options->view_count > 0 && !given))
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " further views; 0 to %d, with the views",
                        options->view_count, MOST_VIEWS);
    SKG_TRY(skg_alloc(options->view_count, sizeof *plan->views, "views", &plan->views));
    for (int64_t v = 0; v < options->view_count; v++) {
        const void *one = (const char *)given + v * given->size;
        skg_view_init(&plan->views[v]);
        SKG_TRY(skg_view_check(one));
        SKG_TRY(skg_struct_read(one, "skg_view", &plan->views[v], sizeof *plan->views));
    }
    options->views = plan->views;
    return SKG_OK;
}

/* The caller's handles are retained, its arrays copied. */
static skg_status keep_options(skg_plan *plan) {
    skg_plan_options *options = &plan->options;
    const double *edges = options->band_kev;
    if (options->response) skg_response_retain(options->response);
    if (options->world) skg_material_retain(options->world);
    SKG_TRY(keep_views(plan));
    if (options->bands < 0 || options->bands > SKG_CHANNELS_MAX || (options->bands > 0 && !edges))
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " bands of energy; 0 to %d, with their edges",
                        options->bands, SKG_CHANNELS_MAX);
    if (options->bands == 0) return SKG_OK;
    SKG_TRY(skg_alloc(options->bands + 1, sizeof *plan->band_kev, "bands", &plan->band_kev));
    for (int64_t c = 0; c <= options->bands; c++) plan->band_kev[c] = edges[c];
    options->band_kev = plan->band_kev;
    return SKG_OK;
}

skg_status skg_plan_create(skg_context *context, skg_scene *scene, const skg_view *view,
                           skg_spectrum *spectrum, const skg_plan_options *options, skg_plan **plan) {
    SKG_TRY(skg_context_enter(context));
    if (!plan || !scene || !spectrum)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_create: scene, spectrum or result is missing");
    *plan = NULL;
    if (scene->count == 0)
        return skg_fail(SKG_ERR_SCENE, "the scene has no parts; add one with skg_scene_add");
    SKG_TRY(skg_view_check(view));
    skg_plan *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "plan", &made));
    skg_refs_init(&made->refs);
    skg_status status = SKG_OK;
    made->context = context, skg_ref(&context->refs);
    made->scene = scene, skg_ref(&scene->refs);
    made->spectrum = spectrum, skg_ref(&spectrum->refs);
    made->structure = scene->structure;
    made->materials = scene->materials;
    skg_plan_options_init(&made->options);
    skg_view_init(&made->view);
    if (options)
        SKG_TRY_CLEANUP(skg_struct_read(options, "skg_plan_options", &made->options, sizeof made->options));
    SKG_TRY_CLEANUP(skg_struct_read(view, "skg_view", &made->view, sizeof made->view));
    SKG_TRY_CLEANUP(keep_options(made));
    SKG_TRY_CLEANUP(check_options(context, &made->options));
    SKG_TRY_CLEANUP(make(made));
    *plan = made;
    return SKG_OK;
cleanup:
    skg_plan_release(&made);
    return status;
}

skg_status skg_plan_retain(skg_plan *plan) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_retain: no plan");
    skg_ref(&plan->refs);
    return SKG_OK;
}

static void release_device_memory(skg_plan *plan) {
    for (int32_t i = 0; i < plan->raster_count; i++) skg_raster_release(&plan->rasters[i]);
    skg_geometry_release(&plan->geometry);
    skg_attenuation_release(&plan->attenuation);
    skg_attenuation_release(&plan->lengths);
    skg_attenuator_release(&plan->attenuator);
    skg_blur_release(&plan->blur);
    skg_detector_release(&plan->detector);
    skg_buffer_release(&plan->image);
    skg_buffer_release(&plan->negative);
    skg_buffer_release(&plan->bad);
    skg_buffer_release(&plan->open_table);
    skg_buffer_release(&plan->gaps);
    skg_buffer_release(&plan->field.image);
    skg_buffer_release(&plan->mix_lists);
    skg_priority_memory_release(&plan->priority_memory);
}

void skg_plan_release(skg_plan **plan) {
    if (!plan || !*plan) return;
    skg_plan *last = *plan;
    *plan = NULL;
    if (!skg_unref(&last->refs)) return;
    release_device_memory(last);
    for (int64_t k = 0; last->caps && k < last->open_count; k++) skg_caps_release(&last->caps[k]);
    skg_free(&last->caps);
    skg_free(&last->told);
    skg_free(&last->open);
    skg_free(&last->overlaps);
    skg_scale_grid_release(&last->grid);
    skg_frame_room_release(&last->room);
    skg_free(&last->channel_names);
    skg_free(&last->band_kev);
    skg_free(&last->views);
    skg_free(&last->mix_sent);
    skg_model_release(&last->model);
    skg_plan_meshes_release(&last->meshes);
    skg_response_release(&last->options.response);
    skg_material_release(&last->options.world);
    skg_spectrum_release(&last->spectrum);
    skg_scene_release(&last->scene);
    skg_context_release(&last->context);
    skg_free(&last);
}

skg_status skg_plan_check_size(const skg_plan *plan, const skg_view *view) {
    if (view->columns == plan->view.columns && view->rows == plan->view.rows) return SKG_OK;
    return skg_fail(SKG_STALE,
                    "the plan is for %" PRId64 " x %" PRId64 " pixels, the view has %" PRId64 " x %" PRId64
                    "; make a plan for it",
                    plan->view.columns, plan->view.rows, view->columns, view->rows);
}

skg_status skg_plan_move(skg_plan *plan, const skg_view *view) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_move: no plan");
    SKG_TRY(skg_context_enter(plan->context));
    SKG_TRY(skg_view_check(view));
    skg_view moved;
    skg_view_init(&moved);
    SKG_TRY(skg_struct_read(view, "skg_view", &moved, sizeof moved));
    SKG_TRY(skg_plan_check_size(plan, &moved));
    plan->view = moved;
    return SKG_OK;
}
