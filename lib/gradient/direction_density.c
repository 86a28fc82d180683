/* The derivative of an image along a direction in which densities or attenuation coefficients change. */
#include "gradient/direction_density.h"

#include "gradient/density.h"
#include "gradient/nodes.h"
#include "gradient/pass.h"

/* Adds the products of rates and slopes of all planes or nodes to a channel of the image. */
static void add_products(const skg_job *job, const skg_pass *pass, int64_t count, const double *slopes,
                         const double *rates, double *image) {
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows, fine = pass->fine;
    const skg_weight_layout layout =
        skg_attenuate_weight_layout(pass->main.raster, (int32_t)job->recipe->samples.fine);
    for (int64_t k = 0; k < count; k++)
        for (int64_t r = 0; r < rows; r++) {
            const double *slope = slopes + k * layout.plane + r * layout.stride,
                         *rate = rates + (k * rows + r) * columns;
            double *to = image + r / fine * (columns / fine);
            for (int64_t c = 0; c < columns; c++) to[c / fine] += slope[c] * rate[c];
        }
}

/* Adds those of all directions to a channel: by the mm of planes, or by the exponents of nodes. */
static void add_all(const skg_job *job, const skg_pass *pass, int64_t channel, int of_nodes) {
    const skg_gradient_work *gradient = skg_gradient_of(job);
    const skg_model *model = &job->recipe->model;
    const int64_t size = job->recipe->view.rows * job->recipe->view.columns;
    for (int64_t d = 0; d < gradient->direction_count; d++) {
        const skg_derivative_work *of = &gradient->directions[d];
        const double *rates = of_nodes ? of->node_changes : of->plane_changes;
        if (rates)
            add_products(job, pass, of_nodes ? model->nodes : model->planes,
                         of_nodes ? gradient->nodes : gradient->planes, rates, of->image + channel * size);
    }
}

skg_status skg_derivative_add_changes(skg_job *job, const skg_pass *pass, const skg_sums *sums, double factor,
                                      int64_t channel) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const skg_model *model = &job->recipe->model;
    const int64_t size = job->recipe->view.rows * job->recipe->view.columns;
    int of_planes = 0, of_nodes = 0;
    for (int64_t d = 0; d < gradient->direction_count; d++) {
        of_planes |= gradient->directions[d].plane_changes != NULL;
        of_nodes |= gradient->directions[d].node_changes != NULL;
    }
    if (of_planes) {
        const skg_weights_wanted wanted = {
            .factor = factor, .channel = (int32_t)channel, .of = SKG_WEIGHTS_OF_PLANES};
        SKG_TRY(skg_gradient_weigh(job, pass, sums, &wanted));
        SKG_TRY(skg_gradient_keep_planes(job, pass));
        add_all(job, pass, channel, 0);
    }
    if (!of_nodes) return SKG_OK;
    for (int64_t k = 0; k < model->channels; k++)
        for (int64_t i = 0; i < size; i++) gradient->adjoint[k * size + i] = k == channel;
    SKG_TRY(skg_gradient_keep_nodes(job, pass, sums, factor));
    add_all(job, pass, channel, 1);
    return SKG_OK;
}
