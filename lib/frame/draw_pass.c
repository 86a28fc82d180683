/* Draws passes: each from the vertices to its share of the image, or to the path lengths that are shown. */
#include "frame/frames.h"
#include "plan/decisions.h"
#include "spectral/model.h"
#include "spectral/verification.h"

#include <math.h>
#include <string.h>

double skg_frame_factor(const skg_recipe *recipe, const skg_frame_work *work, const skg_pass *pass) {
    /* Noise is that of photons in a pixel; its area is divided by later. */
    const int areas =
        recipe->options.quantity == SKG_QUANTITY_FLUENCE && !skg_quantity_is_absolute(&recipe->options);
    const double rays = (double)pass->fine * pass->fine;
    const double area = areas ? skg_camera_pixel_area(&pass->camera) * rays : 1;
    /* A sub-frame has the noise of its share of the photons, and the intensity of the whole. */
    const double noise = work->kind != SKG_OUTPUT_VARIANCE ? 1
                         : recipe->options.noise           ? work->noise.parts
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
    const int lengths = work->kind == SKG_OUTPUT_LENGTHS;
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
    if (work->kind == SKG_OUTPUT_VARIANCE && recipe->options.noise)
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
    skg_pass pass;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_pass_begin(job, work, number, 0, &pass));
    skg_pass_note(job, &pass);
    if (g->count && (g->count == g->room || g->passes->main.raster != pass.main.raster))
        SKG_TRY_CLEANUP(draw_gathered(job, work, number - g->count, g));
    if (skg_raster_passes(pass.main.raster) > 1) {
        SKG_TRY_CLEANUP(skg_waiting_add(job, &pass, g));
        return SKG_OK;
    }
    SKG_TRY_CLEANUP(skg_draw_sums(job, work, &pass));
    status = attenuate_pass(job, work, number, &pass, 0);
cleanup:
    skg_pass_release(&pass);
    return status;
}

skg_status skg_draw_passes(skg_job *job, const skg_frame_work *work, int64_t first, int64_t end) {
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

skg_status skg_draw_lengths(skg_job *job, const skg_frame_work *work, int64_t number, int64_t part,
                            int32_t plane, skg_buffer *lengths, skg_pass *pass) {
    skg_machine *machine = job->machine;
    skg_frame_work of_part = *work;
    of_part.kind = SKG_OUTPUT_LENGTHS;
    of_part.part = part;
    of_part.plane = plane;
    of_part.which = job->recipe->scene->parts[part].volume ? SKG_LENGTHS_CELLS : SKG_LENGTHS_NET;
    SKG_TRY(skg_pass_begin(job, &of_part, number, 1, pass));
    SKG_TRY(skg_draw_sums(job, &of_part, pass));
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
