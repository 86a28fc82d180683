/* The detector: from a frame's intensities to the values of its image. */
#include "frame/frames.h"

#include "spectral/model.h"

double skg_frame_exposure(const skg_recipe *recipe, const skg_view *view) {
    const int is_ratio =
        skg_quantity_is_ratio(&recipe->options) && !skg_quantity_is_absolute(&recipe->options);
    return is_ratio ? 1 : skg_recipe_exposure(recipe, view);
}

/* The layout of the sums of a frame's last pass. They are not read. */
static skg_sums layout_of(const skg_machine *machine, const skg_recipe *recipe, const skg_raster_pin *pin) {
    const int64_t accumulators = skg_raster_plane_count(pin->raster);
    return (skg_sums){.raster = pin->raster,
                      .scale = 1,
                      .mixed = accumulators == recipe->model.planes ? 0 : (int32_t)accumulators,
                      .fine = (int32_t)recipe->samples.fine,
                      .lists = machine->mix_lists.memory.memory};
}

/* Enqueues the flat field of a frame's view, in the layout of the last pass. */
static skg_status find_flat_field(skg_job *job, const skg_frame_work *work) {
    const skg_recipe *recipe = job->recipe;
    skg_machine *machine = job->machine;
    const skg_sums sums = layout_of(machine, recipe, &job->main);
    const skg_flat_field_work flat = {.samples = skg_recipe_averages(recipe) ? &recipe->samples : NULL,
                                      .sums = &sums,
                                      .attenuator = machine->attenuator,
                                      .attenuation = &machine->images,
                                      .layers = &machine->layers,
                                      .pulses = machine->pulses,
                                      .negative = machine->negative.memory,
                                      .exposure = skg_frame_exposure(recipe, work->view)};
    return skg_flat_field_find(&machine->flat_field, &flat, work->view, work->place.output_double,
                               &job->staging);
}

int32_t skg_frame_layers(const skg_job *job, const skg_frame_work *work) {
    if (job->machine->pulses) return SKG_PULSES_LAYERS;
    const int32_t count = job->machine->layers.count, least = job->recipe->model.layers;
    return skg_frame_is_expected(job->recipe, work) && least < count ? least : count;
}

/* The factors of values behind the blur, besides the factors of their channels; finds the flat field, if they are divided
 * by one of their own view. */
static skg_status find_factor(skg_job *job, const skg_frame_work *work, double *factor) {
    const skg_recipe *recipe = job->recipe;
    const int has_flat_field = skg_detector_wants_flat_field(job->machine->detector);
    skg_camera camera;
    SKG_TRY(skg_camera_make(work->view, NULL, 0, 0, &camera));
    *factor = recipe->options.quantity == SKG_QUANTITY_FLUENCE ? 1 / skg_camera_pixel_area(&camera) : 1;
    if (skg_quantity_is_ratio(&recipe->options) && !has_flat_field)
        *factor /= skg_frame_exposure(recipe, work->view);
    return has_flat_field ? find_flat_field(job, work) : SKG_OK;
}

skg_status skg_frame_detect(skg_job *job, const skg_frame_work *work, const skg_image_place *layers) {
    const skg_recipe *recipe = job->recipe;
    skg_machine *machine = job->machine;
    const int64_t columns = recipe->view.columns, rows = recipe->view.rows;
    skg_stage_log *log = &job->staging.log;
    double factor = 1;
    if (machine->pulses)
        SKG_TRY(skg_pulses_run(machine->pulses,
                               recipe->options.noise && !skg_frame_is_expected(recipe, work) ? &work->noise
                                                                                             : NULL,
                               layers, &work->place, columns, rows, log));
    else
        SKG_TRY(skg_layers_blur(&machine->layers, skg_frame_layers(job, work), layers, &work->place, columns,
                                rows, recipe->model.channels, log));
    if (!machine->detector || recipe->linear) return SKG_OK;
    SKG_TRY(find_factor(job, work, &factor));
    return skg_detector_run(machine->detector, &work->noise, work->kind == SKG_OUTPUT_MEAN, factor,
                            machine->flat_field.image.memory, &work->place, columns, rows, log);
}

skg_status skg_frame_detect_variance(skg_job *job, const skg_frame_work *work, const skg_image_place *layers,
                                     cl_mem mean) {
    const skg_recipe *recipe = job->recipe;
    skg_machine *machine = job->machine;
    const int64_t columns = recipe->view.columns, rows = recipe->view.rows;
    skg_stage_log *log = &job->staging.log;
    double factor = 1;
    if (machine->pulses)
        SKG_TRY(skg_pulses_run_variance(machine->pulses, layers, &work->place, columns, rows, log));
    else
        SKG_TRY(skg_layers_blur_variance(&machine->layers, skg_frame_layers(job, work), machine->images.apart,
                                         layers, &work->place, columns, rows, recipe->model.channels, log));
    if (!machine->detector) return SKG_OK;
    SKG_TRY(find_factor(job, work, &factor));
    return skg_detector_run_variance(machine->detector, &work->noise, factor,
                                     machine->flat_field.image.memory, mean, &work->place, columns, rows,
                                     log);
}

skg_status skg_frame_take_logarithm(skg_job *job, const skg_frame_work *work) {
    const skg_sums sums = layout_of(job->machine, job->recipe, &job->main);
    return skg_attenuate_logarithm(job->machine->attenuator, &sums, &job->machine->images, &work->place,
                                   &job->staging.log);
}
