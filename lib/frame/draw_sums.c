/* The sums of a pass: the raster that it calls for, and everything from the vertices to what the attenuation reads. */
#include "frame/frames.h"
#include "plan/decisions.h"

/* The tile that is asked for, in pixels of a pass. Of a finer detector, bands may have to be higher. */
static int32_t tile_of(const skg_recipe *recipe, const skg_pass *pass) {
    const int32_t tile = recipe->strategy == SKG_STRATEGY_TILES ? recipe->options.tile : 0;
    const int64_t least = (pass->camera.rows + SKG_BANDS_MAX - 1) / SKG_BANDS_MAX;
    return tile && pass->fine > 1 && tile < least ? (int32_t)least : tile;
}

int skg_frame_gathers(const skg_recipe *recipe, const skg_machine *machine) {
    return recipe->leaky_count == 0 && machine->volumes.count == 0 && !recipe->priority_possible;
}

/* How many passes the raster of this one draws together. What other kernels do to its sums needs a pass by itself. frames: those that
 * may be drawn together, or else 1. */
static int32_t passes_together(const skg_recipe *recipe, const skg_machine *machine, int64_t number,
                               int64_t frames, const skg_pass *pass, int32_t *side) {
    const skg_passes_request request = {.strategy = recipe->strategy,
                                        .workers = machine->context->device->info.compute_units,
                                        .passes = frames > 1 ? frames : skg_samples_passes(&recipe->samples),
                                        .triangles = skg_scene_triangles(recipe->scene),
                                        .image_bytes = pass->camera.columns * pass->camera.rows *
                                                       pass->planes * pass->kernels.bits / 8};
    const int alone = (number < 0 && frames < 2) || !skg_frame_gathers(recipe, machine) ||
                      (pass->kernels.source_plane && !pass->kernels.parallel) || pass->kernels.half ||
                      pass->kernels.curved;
    *side = 1;
    return alone ? 1 : (frames > 1 ? skg_frames_choose : skg_passes_choose)(&request, side);
}

/* The raster that a pass calls for. */
static skg_raster_options raster_of(const skg_recipe *recipe, const skg_machine *machine, int64_t number,
                                    int64_t frames, const skg_pass *pass) {
    skg_raster_options options = {
        .kernels = pass->kernels,
        .strategy = recipe->strategy,
        .tile = tile_of(recipe, pass),
        .more_sums = recipe->leaky_count > 0 || machine->volumes.count > 0,
        .columns = pass->camera.columns,
        .rows = pass->camera.rows,
        .planes = pass->planes,
        .triangles = machine->geometry.triangles,
    };
    options.passes = passes_together(recipe, machine, number, frames, pass, &options.side);
    return options;
}

/* Pins a raster for a pass, and reports its layout. */
static skg_status pin(skg_machine *machine, const skg_raster_options *options, skg_pass *pass,
                      skg_outcome *outcome) {
    skg_plan_report *report = &outcome->report;
    SKG_TRY(skg_raster_cache_pin(&machine->rasters, options, &pass->main));
    report->plane_bits = pass->scale.bits;
    skg_raster_tiles(pass->main.raster, &report->tile_columns, &report->tile_rows, &report->tiles);
    return SKG_OK;
}

/* Pins the raster that a pass calls for. alone: 1: the pass is drawn by itself. */
static skg_status pin_raster(const skg_recipe *recipe, skg_machine *machine, int64_t number, skg_pass *pass,
                             int alone, skg_outcome *outcome) {
    skg_raster_options options = raster_of(recipe, machine, number, 1, pass);
    if (alone) options.passes = options.side = 1;
    SKG_TRY(pin(machine, &options, pass, outcome));
    outcome->side = options.passes > 1 ? options.side : 0;
    return SKG_OK;
}

skg_status skg_frame_pin_together(const skg_job *job, skg_pass *pass) {
    const skg_raster_options options =
        raster_of(job->recipe, job->machine, skg_frame_first_pass(job->recipe), job->count, pass);
    return options.passes > 1 && options.side == job->together
               ? pin(job->machine, &options, pass, job->outcome)
               : SKG_OK;
}

/* The first pass of an image of the recipe's view. */
static skg_status fill_first(const skg_recipe *recipe, const skg_machine *machine, skg_pass *pass) {
    const skg_frame_work work = {.view = &recipe->view};
    return skg_pass_fill(recipe, &work, skg_frame_first_pass(recipe), &machine->pass, pass);
}

/* The programs of one pass. */
static skg_status expect_pass(const skg_recipe *recipe, const skg_machine *machine, const skg_pass *pass) {
    const skg_raster_options options = raster_of(recipe, machine, skg_frame_first_pass(recipe), 1, pass);
    const skg_sums sums = {.mixed = pass->mix.sums ? recipe->mixed : 0, .fine = pass->fine};
    skg_attenuation shape;
    skg_image_place place = {0};
    skg_decide_attenuation(recipe, &shape);
    cl_int *extents = NULL;
    SKG_TRY(skg_alloc(4 * pass->planes, sizeof *extents, "extents", &extents));
    skg_pass_extents(pass, extents);
    const skg_status status = skg_raster_prefetch(machine->context, &options, extents);
    skg_free(&extents);
    SKG_TRY(status);
    if (pass->priority.count) SKG_TRY(skg_hits_prefetch(machine->context, pass));
    return skg_attenuate_prefetch(machine->attenuator, &options, &sums, &shape, &place);
}

void skg_frame_prefetch(const skg_recipe *recipe, const skg_machine *machine) {
    skg_pass pass;
    if (fill_first(recipe, machine, &pass) == SKG_OK) (void)expect_pass(recipe, machine, &pass);
    skg_pass_release(&pass);
}

skg_status skg_frame_prepare(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome) {
    skg_pass pass;
    skg_status status = fill_first(recipe, machine, &pass);
    if (status == SKG_OK)
        status = pin_raster(recipe, machine, skg_frame_first_pass(recipe), &pass, 0, outcome);
    skg_pass_release(&pass);
    return status;
}

skg_status skg_pass_begin(skg_job *job, const skg_frame_work *work, int64_t number, int alone,
                          skg_pass *pass) {
    SKG_TRY(skg_pass_fill(job->recipe, work, number, &job->machine->pass, pass));
    return pin_raster(job->recipe, job->machine, number, pass, alone, job->outcome);
}

void skg_pass_note(skg_job *job, const skg_pass *pass) {
    skg_raster_pin_copy(&pass->main, &job->main);
    skg_warn_unseen(job->machine->context, pass->scene, &pass->camera, pass->extents, pass->fine,
                    job->outcome);
}

skg_status skg_frame_update_meshes(skg_job *job) {
    const skg_recipe *recipe = job->recipe;
    if (job->then.meshes) return SKG_OK;
    SKG_TRY(skg_plan_meshes_check(&recipe->meshes, recipe->scene));
    return skg_geometry_update(&job->machine->geometry, recipe->meshes.meshes, &job->staging);
}

skg_status skg_draw_sums(skg_job *job, const skg_frame_work *work, const skg_pass *pass) {
    skg_machine *machine = job->machine;
    const skg_recipe *recipe = job->recipe;
    skg_stage_log *log = &job->staging.log;
    const int is_image = work->kind != SKG_OUTPUT_LENGTHS;
    const skg_leaky_parts leaky = {.count = recipe->leaky_count,
                                   .parts = recipe->leaky,
                                   .repair = recipe->options.repair,
                                   .strategy = recipe->leaky_strategy,
                                   .tile = recipe->options.tile};
    cl_int *extents = NULL;
    SKG_ASSERT(pass->main.raster != NULL);
    const cl_kernel projection = skg_raster_projection(pass->main.raster);
    SKG_TRY(skg_frame_update_meshes(job));
    SKG_TRY(skg_geometry_weigh(machine->context, &machine->geometry, &pass->camera, pass->parts,
                               pass->scale.scale));
    if (!work->reuses || !skg_geometry_take_projection(&machine->geometry, projection))
        SKG_TRY(skg_geometry_project(machine->context, &machine->geometry, projection, log));
    if (work->reuses && is_image && skg_raster_keeps(pass->main.raster, &machine->geometry)) return SKG_OK;
    if (pass->kernels.half) skg_raster_set_rays(pass->main.raster, &pass->camera);
    if (pass->priority.count)
        SKG_TRY(skg_hits_count(pass, &machine->geometry, &machine->hits, &job->staging));
    SKG_TRY(skg_staging_take(&job->staging, 4 * pass->planes, sizeof *extents, "extents", &extents));
    skg_pass_extents(pass, extents);
    SKG_TRY(skg_raster_run(pass->main.raster, &machine->geometry, extents, log));
    if (pass->priority.count)
        SKG_TRY(skg_hits_settle(pass, &machine->geometry, &machine->hits, &job->staging));
    if (is_image && machine->volumes.count)
        SKG_TRY(skg_volumes_add(&machine->volumes, pass, &machine->hits, &job->staging));
    if (!is_image && work->which == SKG_LENGTHS_CELLS)
        SKG_TRY(skg_volumes_add_alone(&machine->volumes, &recipe->model, work->part, work->plane, pass,
                                      &machine->hits, &job->staging));
    if (leaky.count == 0) {
        if (is_image) skg_raster_keep(pass->main.raster, &machine->geometry);
        return SKG_OK;
    }
    return skg_leaky_run(&leaky, pass, &machine->geometry, &machine->rasters, &machine->leaky,
                         &job->results.leaky, &job->staging);
}

skg_status skg_frame_sums(skg_job *job, const skg_pass *pass, int32_t place, skg_sums *sums) {
    const skg_recipe *recipe = job->recipe;
    skg_mix_lists *lists = &job->machine->mix_lists;
    if (pass->mix.sums)
        SKG_TRY(skg_mix_lists_send(lists, pass->mix.lists, (int64_t)recipe->mixed * recipe->model.planes,
                                   recipe->options.precision == SKG_PRECISION_DOUBLE, &job->staging));
    *sums = (skg_sums){.raster = pass->main.raster,
                       .pass = place,
                       .scale = pass->scale.scale,
                       .mixed = pass->mix.sums ? recipe->mixed : 0,
                       .fine = pass->fine,
                       .lists = lists->memory.memory};
    return SKG_OK;
}
