/* The passes of a frame: each from the vertices to its share of the image. */
#include "frame/frames.h"
#include "plan/decisions.h"
#include "spectral/model.h"
#include "spectral/verification.h"

#include <math.h>
#include <string.h>

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

/* Enqueues the raster of all parts, and what priorities and leaky parts change in its sums. */
static skg_status draw_sums(skg_job *job, const skg_frame_work *work, const skg_pass *pass) {
    skg_machine *machine = job->machine;
    const skg_recipe *recipe = job->recipe;
    skg_stage_log *log = &job->staging.log;
    const int is_image = work->shows != SKG_OUTPUT_LENGTHS;
    const skg_leaky_parts leaky = {.count = recipe->leaky_count,
                                   .parts = recipe->leaky,
                                   .repair = recipe->options.repair,
                                   .strategy = recipe->leaky_strategy,
                                   .tile = recipe->options.tile};
    cl_int *extents = NULL;
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
    if (!is_image && work->kind == SKG_LENGTHS_CELLS)
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

double skg_frame_factor(const skg_recipe *recipe, const skg_frame_work *work, const skg_pass *pass) {
    /* Noise is that of photons in a pixel; its area is divided by later. */
    const int areas =
        recipe->options.quantity == SKG_QUANTITY_FLUENCE && !skg_quantity_is_absolute(&recipe->options);
    const double rays = (double)pass->fine * pass->fine;
    const double area = areas ? skg_camera_pixel_area(&pass->camera) * rays : 1;
    /* A sub-frame has the noise of its share of the photons, and the intensity of the whole. */
    const double noise = work->shows != SKG_OUTPUT_VARIANCE ? 1
                         : recipe->options.noise            ? work->noise.parts
                                                            : 0;
    return noise * skg_frame_exposure(recipe, work->view) /
           (area * (double)skg_samples_count(&recipe->samples));
}

/* The exponent above which, as a negative number, more is subtracted than there is. A length may be wrong by some of the scale's bound if a
 * face lies nearly along the ray (docs/numerics.md): below a ten-thousandth of the bound it shows nothing. What is thinner than the
 * world takes from it, and there is no more than the world on the longest way. */
static double least_of(const skg_recipe *recipe, const skg_pass *pass, int lengths) {
    const skg_model *model = &recipe->model;
    const double noise = 1e-4 * pass->scale.bound + 1e-6;
    if (lengths || model->world_plane < 0) return -noise;
    const double per_mm = model->world_weight * model->coefficients[model->world_plane];
    return -noise - fabs(per_mm) * skg_way_longest(&pass->camera);
}

/* Enqueues the image of one pass from the sums. */
static skg_status attenuate_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                 const skg_pass *pass, int32_t place_of_pass) {
    const skg_recipe *recipe = job->recipe;
    skg_machine *machine = job->machine;
    const int lengths = work->shows == SKG_OUTPUT_LENGTHS;
    const double share = 1 / (double)skg_samples_count(&recipe->samples);
    const double factor = lengths ? 1 : skg_frame_factor(recipe, work, pass);
    const double least = least_of(recipe, pass, lengths);
    const cl_int none = 0;
    skg_attenuation attenuation = lengths ? machine->lengths : machine->images;
    skg_image_place place = work->place;
    skg_noise_args noise = work->noise;
    place.add = number > 0;
    noise.sample = number > 0 ? (cl_int)number * pass->fine * pass->fine : 0;
    if (skg_frame_is_expected(recipe, work)) attenuation.noise = 0;
    /* The variance is a sum over nodes as the mean is, with other weights. Without quantum noise it is 0. */
    if (work->shows == SKG_OUTPUT_VARIANCE && recipe->options.noise)
        attenuation.weights = attenuation.variances;
    memcpy(attenuation.window, pass->window, sizeof attenuation.window);
    const int is_last = number < 0 || number + 1 == skg_samples_passes(&recipe->samples);
    if (is_last && !work->followed && !job->uncounted) /* the last pass's count is reported */
        SKG_CL_TRY(clEnqueueFillBuffer(machine->context->device->queue, machine->negative.memory, &none,
                                       sizeof none, 0, sizeof none, 0, NULL, NULL));
    job->uncounted = 0;
    skg_sums sums;
    SKG_TRY(skg_frame_sums(job, pass, place_of_pass, &sums));
    return skg_attenuate(machine->attenuator, &sums, &pass->camera, &attenuation, factor, share, least,
                         machine->negative.memory, &noise, &place, &job->staging.log);
}

/* Enqueues the passes that wait, from the vertices to their shares of the image. first: number of the first of them */
static skg_status draw_gathered(skg_job *job, const skg_frame_work *work, int64_t first, skg_waiting *g) {
    skg_status status = skg_waiting_draw(job, g, NULL);
    for (int32_t p = 0; p < g->count && status == SKG_OK; p++)
        status = attenuate_pass(job, work, first + p, &g->passes[p], p);
    skg_waiting_empty(g);
    return status;
}

/* One pass: from the vertices to its share of the image, or to those that wait. */
static skg_status draw_pass(skg_job *job, const skg_frame_work *work, int64_t number, skg_waiting *g) {
    skg_machine *machine = job->machine;
    skg_pass pass;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_pass_fill(job->recipe, work, number, &machine->pass, &pass));
    SKG_TRY_CLEANUP(pin_raster(job->recipe, machine, number, &pass, 0, job->outcome));
    skg_raster_pin_copy(&pass.main, &job->main);
    skg_warn_unseen(machine->context, pass.scene, &pass.camera, pass.extents, pass.fine, job->outcome);
    if (g->count && (g->count == g->room || g->passes->main.raster != pass.main.raster))
        SKG_TRY_CLEANUP(draw_gathered(job, work, number - g->count, g));
    if (skg_raster_passes(pass.main.raster) > 1) {
        SKG_TRY_CLEANUP(skg_waiting_add(job, &pass, g));
        return SKG_OK;
    }
    SKG_TRY_CLEANUP(draw_sums(job, work, &pass));
    status = attenuate_pass(job, work, number, &pass, 0);
cleanup:
    skg_pass_release(&pass);
    return status;
}

skg_status skg_frame_draw_passes(skg_job *job, const skg_frame_work *work, int64_t first, int64_t end) {
    skg_waiting g = {.staging = &job->staging};
    skg_status status = SKG_OK;
    SKG_ASSERT(-1 <= first && first < end);
    if (work->drawn) return attenuate_pass(job, work, first, work->drawn, work->drawn_place);
    for (int64_t p = first; p < end; p++) SKG_TRY_CLEANUP(draw_pass(job, work, p, &g));
    status = draw_gathered(job, work, end - g.count, &g);
cleanup:
    skg_waiting_release(&g);
    return status;
}

skg_status skg_frame_draw_sums(skg_job *job, const skg_frame_work *work, int64_t number, skg_pass *pass) {
    SKG_TRY(skg_pass_fill(job->recipe, work, number, &job->machine->pass, pass));
    SKG_TRY(pin_raster(job->recipe, job->machine, number, pass, 1, job->outcome));
    skg_raster_pin_copy(&pass->main, &job->main);
    skg_warn_unseen(job->machine->context, pass->scene, &pass->camera, pass->extents, pass->fine,
                    job->outcome);
    return draw_sums(job, work, pass);
}

skg_status skg_frame_draw_lengths(skg_job *job, const skg_frame_work *work, int64_t number, int64_t part,
                                  int32_t plane, skg_buffer *lengths, skg_pass *pass) {
    skg_machine *machine = job->machine;
    skg_frame_work of_part = *work;
    of_part.shows = SKG_OUTPUT_LENGTHS;
    of_part.part = part;
    of_part.plane = plane;
    of_part.kind = job->recipe->scene->parts[part].volume ? SKG_LENGTHS_CELLS : SKG_LENGTHS_NET;
    SKG_TRY(skg_pass_fill(job->recipe, &of_part, number, &machine->pass, pass));
    SKG_TRY(pin_raster(job->recipe, machine, number, pass, 1, job->outcome));
    SKG_TRY(draw_sums(job, &of_part, pass));
    const int is_double = pass->kernels.precision == SKG_PRECISION_DOUBLE;
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows;
    SKG_TRY(skg_buffer_reserve(machine->context, lengths,
                               columns * rows * (int64_t)(is_double ? sizeof(double) : sizeof(float)),
                               CL_MEM_READ_WRITE, "path lengths"));
    of_part.place = (skg_image_place){.memory = lengths->memory,
                                      .output_double = is_double,
                                      .row_stride = columns,
                                      .channel_stride = rows * columns};
    pass->fine = 1; /* every ray is shown */
    return attenuate_pass(job, &of_part, 0, pass, 0);
}
