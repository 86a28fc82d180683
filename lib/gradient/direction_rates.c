/* How fast the planes and exponents of rays change along a direction, by densities and attenuation coefficients. */
#include "gradient/direction_rates.h"

void skg_derivative_clear_rates(skg_job *job) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    for (int64_t d = 0; d < gradient->direction_count; d++) {
        skg_free(&gradient->directions[d].plane_changes);
        skg_free(&gradient->directions[d].node_changes);
    }
}

/* Adds a multiple of the lengths to the rates of one plane or node. */
static void add_scaled(int64_t rays, double scale, const double *lengths, double *rates) {
    for (int64_t i = 0; scale != 0 && i < rays; i++) rates[i] += scale * lengths[i];
}

/* The rates along one direction. */
static skg_status add_lengths(const skg_model *model, int64_t rays, int64_t part, const double *own,
                              const double *lengths, skg_derivative_work *of) {
    const skg_direction *direction = &of->direction;
    if (direction->densities && direction->densities[part] != 0) {
        double **rates = &of->plane_changes;
        if (!*rates) SKG_TRY(skg_alloc(model->planes * rays, sizeof **rates, "derivative", rates));
        for (int64_t k = 0; k < model->planes; k++)
            add_scaled(rays, direction->densities[part] * own[k], lengths, *rates + k * rays);
    }
    if (direction->attenuations) {
        double **rates = &of->node_changes;
        if (!*rates) SKG_TRY(skg_alloc(model->nodes * rays, sizeof **rates, "derivative", rates));
        for (int64_t n = 0; n < model->nodes; n++)
            add_scaled(rays, SKG_PER_MM * direction->attenuations[part * model->nodes + n], lengths, *rates + n * rays);
    }
    return SKG_OK;
}

skg_status skg_derivative_add_lengths(skg_job *job, const skg_pass *pass, int64_t part, const double *own,
                                      const double *lengths) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    for (int64_t d = 0; d < gradient->direction_count; d++)
        SKG_TRY(add_lengths(&job->recipe->model, pass->camera.rows * pass->camera.columns, part, own, lengths,
                            &gradient->directions[d]));
    return SKG_OK;
}
