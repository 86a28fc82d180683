/* The derivatives of a loss by the sums of a pass: what hits are worth (kernels/gradient/weights.cl). */
#include "gradient/gather.h"
#include "gradient/volumes.h"

#include <skiagraph/plan.h>

#include <string.h>

/* Weights that are new memory are 0: parts that only displace others weigh hits by 0 times what stands there, which has to be
 * finite. */
static skg_status reserve_weights(const skg_pass *pass, int64_t bytes, skg_gradient_memory *memory) {
    skg_context *context = pass->main.raster->context;
    const cl_int none = 0;
    if (bytes <= memory->weights.bytes) return SKG_OK;
    SKG_TRY(skg_buffer_reserve(context, &memory->weights, bytes, CL_MEM_READ_WRITE, "weights of a gradient"));
    const cl_int code = clEnqueueFillBuffer(context->device->queue, memory->weights.memory, &none,
                                            sizeof none, 0, (size_t)bytes, 0, NULL, NULL);
    if (code == CL_SUCCESS) return SKG_OK;
    skg_buffer_release(&memory->weights);
    return skg_cl_fail(code, "clEnqueueFillBuffer", __FILE__, __LINE__);
}

skg_status skg_gradient_reserve(const skg_pass *pass, int64_t planes, skg_gradient_memory *memory) {
    skg_context *context = pass->main.raster->context;
    const int64_t size = skg_gradient_real_size(pass->kernels.precision);
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    const int64_t most = planes > layout.planes + 3 ? planes : layout.planes + 3;
    /* Lanes without a hit read behind their rows. */
    const int64_t behind = SKG_SPARE_ROWS * layout.stride + SKG_SPARE_COLUMNS;
    SKG_TRY(skg_buffer_reserve(context, &memory->most, layout.planes * layout.items * size, CL_MEM_READ_WRITE,
                               "weights of a gradient"));
    SKG_TRY(skg_buffer_reserve(context, &memory->of_rays, SKG_RAY_SUMS * layout.items * size,
                               CL_MEM_READ_WRITE, "weights of a gradient"));
    return reserve_weights(pass, (most * layout.plane + behind) * size, memory);
}

/* Which planes of accumulators are wanted. */
static void mark_planes(const skg_pass *pass, const skg_weights_wanted *wanted, int32_t *planes) {
    for (int64_t p = 0; wanted->of == SKG_WEIGHTS_OF_PARTS && p < pass->scene->count; p++)
        for (int32_t c = 0; (!wanted->parts || wanted->parts[p]) && c < pass->parts[p].contributions; c++)
            planes[pass->parts[p].contribution[c].plane] = 1;
    if (wanted->of == SKG_WEIGHTS_OF_PARTS) skg_volumes_mark(pass->volumes, wanted->parts, planes);
}

/* Uploads which planes are wanted, unless the device has it from before. */
static skg_status send_wanted(const skg_pass *pass, const skg_weights_wanted *wanted,
                              skg_gradient_memory *memory, skg_staging *staging) {
    const int64_t count = skg_attenuate_weight_layout(pass->main.raster, pass->fine).planes;
    const int64_t bytes = count * (int64_t)sizeof(int32_t);
    int32_t *planes = NULL;
    SKG_TRY(skg_staging_take(staging, count, sizeof *planes, "gradient", &planes));
    mark_planes(pass, wanted, planes);
    if (memory->wanted_count == count && memcmp(memory->wanted_now, planes, (size_t)bytes) == 0)
        return SKG_OK;
    if (memory->wanted_count < count)
        SKG_TRY(skg_realloc(count, sizeof *memory->wanted_now, "gradient", &memory->wanted_now));
    memory->wanted_count = 0; /* until the device has it */
    SKG_TRY(skg_staging_write(staging, &memory->wanted, bytes, planes, "gradient"));
    memcpy(memory->wanted_now, planes, (size_t)bytes);
    memory->wanted_count = count;
    return SKG_OK;
}

skg_status skg_gradient_transpose(skg_attenuator *attenuator, const skg_pass *pass, const skg_sums *sums,
                                  const skg_attenuation *attenuation, const skg_weights_wanted *wanted,
                                  skg_gradient_memory *memory, skg_staging *staging) {
    SKG_TRY(send_wanted(pass, wanted, memory, staging));
    const skg_transposition asked = {.factor = wanted->factor,
                                     .channel = wanted->channel,
                                     .of_planes = wanted->of == SKG_WEIGHTS_OF_PLANES,
                                     .rays = wanted->rays,
                                     .relative = wanted->relative,
                                     .adjoint = memory->adjoint.memory,
                                     .wanted = memory->wanted.memory,
                                     .weights = memory->weights.memory,
                                     .most = memory->most.memory,
                                     .of_rays = memory->of_rays.memory};
    return skg_attenuate_transpose(attenuator, sums, &pass->camera, attenuation, &asked, &staging->log);
}

skg_status skg_gradient_read_ray_sums(const skg_pass *pass, const skg_gradient_memory *memory,
                                      skg_staging *staging, double sums[SKG_RAY_SUMS]) {
    const int64_t items = skg_attenuate_weight_layout(pass->main.raster, pass->fine).items;
    double *of_items = NULL;
    SKG_TRY(skg_staging_take(staging, SKG_RAY_SUMS * items, sizeof *of_items, "gradient", &of_items));
    SKG_TRY(skg_gradient_read(pass, memory->of_rays.memory, 0, SKG_RAY_SUMS * items, of_items));
    for (int k = 0; k < SKG_RAY_SUMS; k++) {
        sums[k] = 0;
        for (int64_t i = 0; i < items; i++) sums[k] += of_items[k * items + i];
    }
    return SKG_OK;
}
