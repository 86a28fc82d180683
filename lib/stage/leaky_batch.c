/* Memory and programs of leaky parts, several of which are drawn together. */
#include "stage/leaks.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <inttypes.h>

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

static skg_status find_caps(const skg_leaky_batch *batch, const skg_mesh *mesh, skg_caps *caps) {
    int64_t sheets = 0;
    double area = 0;
    SKG_TRY(skg_caps_find(mesh, caps));
    SKG_TRY(skg_caps_sheets(mesh, caps, &sheets, &area));
    if (sheets > 0)
        skg_log(batch->raster->context, SKG_LOG_WARNING,
                "%s: %" PRId64
                " of its pieces, of %.4g mm2, enclose nothing when their open edges are closed, so that rays "
                "that are traced again do not see them; close the mesh, or take the repair \"neighbours\"",
                mesh->name, sheets, area);
    return SKG_OK;
}

skg_status skg_leaky_caps(const skg_leaky_batch *batch, int64_t index, const skg_mesh *mesh,
                          const skg_caps **caps) {
    skg_caps *own = &batch->memory->caps[index];
    if (!own->first) SKG_TRY(find_caps(batch, mesh, own));
    *caps = own;
    return SKG_OK;
}
