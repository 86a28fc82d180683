/* Derivatives by the attenuation coefficients of parts at the energies of a plan. */
#include "gradient/nodes.h"

#include "core/threads.h"
#include "gradient/adjoint.h"

#include <string.h>

/* The derivatives by the exponents of a pass. */
typedef struct {
    skg_job *job;
    const skg_pass *pass;
    const skg_sums *sums;
    double factor;
    skg_attenuation attenuation; /* shows intensities; its buffers are borrowed */
    skg_weight_layout layout;
} nodes_work;

/* The derivatives by the logarithm of the intensity of every ray. */
static skg_status transpose(const nodes_work *w, double *values) {
    skg_machine *machine = w->job->machine;
    const skg_weights_wanted wanted = {
        .factor = w->factor, .channel = -1, .of = SKG_WEIGHTS_OF_RAYS, .rays = SKG_RAYS_PLANES};
    SKG_TRY(skg_gradient_transpose(machine->attenuator, w->pass, w->sums, &w->attenuation, &wanted,
                                   skg_gradient_of(w->job)->memory, &w->job->staging));
    return skg_gradient_read(w->pass, skg_gradient_of(w->job)->memory->weights.memory,
                             (w->layout.planes + 1) * w->layout.plane, w->layout.plane, values);
}

/* The attenuation of one energy is its exponent. Rays that jaws stop do not depend on it. */
static void take_exponents(const nodes_work *w, double *node) {
    const skg_camera *camera = &w->pass->camera;
    const int32_t *window = w->attenuation.window;
    const double *adjoint = skg_gradient_of(w->job)->adjoint;
    for (int64_t r = 0; r < camera->rows; r++)
        for (int64_t c = 0; c < camera->columns; c++) {
            const int arrives = !w->attenuation.collimated ||
                                (c >= window[0] && c < window[1] && r >= window[2] && r < window[3]);
            node[r * w->layout.stride + c] = arrives ? adjoint[r * camera->columns + c] : 0;
        }
}

/* From derivatives by -ln of the intensities, which the attenuation shows, to those by the intensities: over minus the intensity, which
 * is the derivative of its own by its logarithm. A pixel without intensity is constant. */
static skg_status undo_logarithm(nodes_work *w, double *values) {
    const skg_camera *camera = &w->pass->camera;
    const int64_t size = camera->rows * camera->columns, channels = w->attenuation.channels;
    const double *adjoint = skg_gradient_of(w->job)->adjoint;
    double *ones = NULL, *shown = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(channels * size, sizeof *ones, "gradient", &ones));
    SKG_TRY_CLEANUP(skg_alloc(w->layout.plane, sizeof *shown, "gradient", &shown));
    for (int64_t k = 0; k < channels; k++) {
        for (int64_t i = 0; i < channels * size; i++) ones[i] = i / size == k;
        SKG_TRY_CLEANUP(skg_adjoint_send(w->job, ones));
        SKG_TRY_CLEANUP(transpose(w, shown));
        for (int64_t i = 0; i < size; i++) {
            const double intensity = shown[i / camera->columns * w->layout.stride + i % camera->columns];
            values[k * size + i] = intensity > 0 ? -adjoint[k * size + i] / intensity : 0;
        }
    }
cleanup:
    skg_free(&ones);
    skg_free(&shown);
    return status;
}

/* Node after node: the weights of all others are 0. */
static skg_status run_nodes(nodes_work *w) {
    skg_machine *machine = w->job->machine;
    const skg_buffer all = machine->images.weights;
    skg_buffer *alone = &skg_gradient_of(w->job)->memory->node;
    double *nodes = skg_gradient_of(w->job)->nodes;
    const size_t row = (size_t)all.bytes / (size_t)w->attenuation.nodes;
    const cl_int none = 0;
    cl_command_queue queue = machine->context->device->queue;
    SKG_TRY(skg_buffer_reserve(machine->context, alone, all.bytes, CL_MEM_READ_WRITE, "gradient"));
    w->attenuation.weights = *alone;
    for (int32_t n = 0; n < w->attenuation.nodes; n++) {
        double *node = nodes + n * w->layout.plane;
        SKG_CL_TRY(clEnqueueFillBuffer(queue, alone->memory, &none, sizeof none, 0, (size_t)all.bytes, 0,
                                       NULL, NULL));
        SKG_CL_TRY(clEnqueueCopyBuffer(queue, all.memory, alone->memory, (size_t)n * row, (size_t)n * row,
                                       row, 0, NULL, NULL));
        SKG_TRY(transpose(w, node));
        for (int64_t i = 0; i < w->layout.plane; i++) node[i] = -node[i];
    }
    return SKG_OK;
}

skg_status skg_gradient_keep_nodes(skg_job *job, const skg_pass *pass, const skg_sums *sums, double factor) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    nodes_work w = {
        .job = job, .pass = pass, .sums = sums, .factor = factor, .attenuation = job->machine->images};
    const int32_t shown = w.attenuation.shown;
    const int64_t count = w.attenuation.channels * pass->camera.rows * pass->camera.columns;
    double *intensities = NULL;
    skg_status status = SKG_OK;
    memcpy(w.attenuation.window, pass->window, sizeof w.attenuation.window);
    w.attenuation.shown = SKG_SHOW_INTENSITY;
    w.layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    if (!gradient->nodes)
        SKG_TRY(skg_alloc(w.attenuation.nodes * w.layout.plane, sizeof *gradient->nodes, "gradient",
                          &gradient->nodes));
    if (shown == SKG_SHOW_EXPONENT) {
        take_exponents(&w, gradient->nodes);
        return SKG_OK;
    }
    if (shown == SKG_SHOW_LOGARITHM) {
        SKG_TRY_CLEANUP(skg_alloc(count, sizeof *intensities, "gradient", &intensities));
        SKG_TRY_CLEANUP(undo_logarithm(&w, intensities));
    }
    SKG_TRY_CLEANUP(skg_adjoint_send(job, intensities ? intensities : gradient->adjoint));
    status = run_nodes(&w);
cleanup:
    skg_free(&intensities);
    return status;
}

/* One part. */
typedef struct {
    const skg_job *job;
    const skg_pass *pass;
    const double *lengths;
    double *sums; /* [nodes] */
} part_work;

static skg_status add_node(void *user, int64_t number) {
    const part_work *w = user;
    const int64_t columns = w->pass->camera.columns, rows = w->pass->camera.rows;
    const skg_weight_layout layout =
        skg_attenuate_weight_layout(w->pass->main.raster, (int32_t)w->job->recipe->samples.fine);
    const double *node = skg_gradient_of(w->job)->nodes + number * layout.plane;
    for (int64_t r = 0; r < rows; r++)
        for (int64_t c = 0; c < columns; c++)
            w->sums[number] += node[r * layout.stride + c] * w->lengths[r * columns + c];
    return SKG_OK;
}

skg_status skg_gradient_add_nodes(const skg_job *job, const skg_pass *pass, int64_t part,
                                  const double *lengths) {
    const int64_t nodes = job->recipe->model.nodes;
    SKG_ASSERT(0 <= part && part < job->recipe->scene->count && skg_gradient_of(job)->attenuations);
    part_work w = {.job = job,
                   .pass = pass,
                   .lengths = lengths,
                   .sums = skg_gradient_of(job)->attenuations + part * nodes};
    return skg_parallel(nodes, add_node, &w);
}
