/* Memory and programs of leaky parts, several of which are drawn together. */
#include "stage/leaks.h"
#include "stage/raster_private.h"

skg_status skg_leaky_memory_create(skg_context *context, int64_t count, skg_leaky_memory *memory) {
    *memory = (skg_leaky_memory){.count = count};
    SKG_TRY(skg_alloc(count, sizeof *memory->caps, "caps", &memory->caps));
    return skg_buffer_reserve(context, &memory->verdicts,
                              count * (1 + SKG_FIRST_BAD) * (int64_t)sizeof(cl_int), CL_MEM_READ_WRITE,
                              "bad pixels");
}

void skg_leaky_memory_release(skg_leaky_memory *memory) {
    skg_buffer_release(&memory->verdicts);
    skg_buffer_release(&memory->table);
    skg_buffer_release(&memory->gaps);
    for (int64_t k = 0; memory->caps && k < memory->count; k++) skg_caps_release(&memory->caps[k]);
    skg_free(&memory->caps);
}

int64_t skg_leaky_memory_bytes(const skg_leaky_memory *memory) {
    return memory->verdicts.bytes + memory->gaps.bytes;
}

skg_status skg_leaky_program(const skg_leaky_batch *batch, cl_program *program) {
    static const char *const files[] = {"leaky.cl"};
    const skg_raster *raster = batch->raster;
    const skg_kernel_options options = {.precision = raster->options.kernels.precision,
                                        .bits = raster->options.kernels.bits};
    return skg_kernels_get(raster->context, &options, 1, files, NULL, program);
}

skg_leaky_args skg_leaky_scalars(const skg_leaky_batch *batch) {
    return (skg_leaky_args){.layout = batch->raster->layout, .parts = (SKG_INT)batch->parts};
}

skg_status skg_leaky_caps(skg_leaky_memory *memory, int64_t index, const skg_mesh *mesh,
                          const skg_caps **caps) {
    if (!memory->caps[index].first) SKG_TRY(skg_caps_find(mesh, &memory->caps[index]));
    *caps = &memory->caps[index];
    return SKG_OK;
}
