/* The derivatives by the densities of parts: the sum over pixels and planes of the length through a part, times what a mm of its
 * material adds to the plane, times the derivative by the plane. */
#include "frame/gradient_density.h"

#include <string.h>

skg_status skg_gradient_keep_planes(skg_job *job, const skg_pass *pass) {
    struct skg_gradient_work *gradient = job->gradient;
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    const int64_t count = job->recipe->model.planes * layout.plane;
    if (!gradient->planes) SKG_TRY(skg_alloc(count, sizeof *gradient->planes, "gradient", &gradient->planes));
    return skg_gradient_read(pass, job->machine->gradient.weights.memory, 0, count, gradient->planes);
}

skg_status skg_gradient_place_lengths(skg_job *job, const skg_pass *pass, skg_image_place *place) {
    skg_machine *machine = job->machine;
    const int is_double = pass->kernels.precision == SKG_PRECISION_DOUBLE;
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows;
    SKG_TRY(skg_buffer_reserve(machine->context, &machine->gradient.lengths,
                               columns * rows * (int64_t)(is_double ? sizeof(double) : sizeof(float)),
                               CL_MEM_READ_WRITE, "gradient"));
    *place = (skg_image_place){.memory = machine->gradient.lengths.memory,
                               .output_double = is_double,
                               .row_stride = columns,
                               .channel_stride = rows * columns};
    return SKG_OK;
}

/* What a mm of a part's own material adds to the planes: the sum of what the part and all parts around it contribute. */
static void find_own(const skg_recipe *recipe, int64_t part, double *own) {
    const skg_model *model = &recipe->model;
    memset(own, 0, (size_t)model->planes * sizeof *own);
    if (model->world_plane >= 0) own[model->world_plane] = model->world_weight;
    for (int64_t p = part; p >= 0; p = recipe->scene->parts[p].inside)
        for (int64_t c = model->first_contribution[p]; c < model->first_contribution[p + 1]; c++)
            own[model->contributions[c].plane] += model->contributions[c].weight;
}

skg_status skg_gradient_add_density(skg_job *job, const skg_pass *pass, int64_t part) {
    struct skg_gradient_work *gradient = job->gradient;
    const skg_recipe *recipe = job->recipe;
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows, planes = recipe->model.planes;
    /* The raster of images has rows of the same length. */
    const skg_weight_layout layout =
        skg_attenuate_weight_layout(pass->main.raster, (int32_t)recipe->samples.fine);
    double *lengths = NULL, *own = NULL, sum = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(columns * rows, sizeof *lengths, "gradient", &lengths));
    SKG_TRY_CLEANUP(skg_alloc(planes, sizeof *own, "gradient", &own));
    SKG_TRY_CLEANUP(
        skg_gradient_read(pass, job->machine->gradient.lengths.memory, 0, columns * rows, lengths));
    find_own(recipe, part, own);
    for (int64_t k = 0; k < planes; k++) {
        const double *slopes = gradient->planes + k * layout.plane;
        for (int64_t r = 0; r < rows && own[k] != 0; r++)
            for (int64_t c = 0; c < columns; c++)
                sum += own[k] * slopes[r * layout.stride + c] * lengths[r * columns + c];
    }
    gradient->densities[part] += sum;
cleanup:
    skg_free(&lengths);
    skg_free(&own);
    return status;
}
