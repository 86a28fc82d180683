/* Memory of gradients on the device and beside it, which a plan keeps from call to call. */
#include "gradient/device.h"
#include "stage/machine.h"

static void release(void *of) {
    skg_gradient_memory *memory = of;
    skg_buffer *const buffers[] = {&memory->adjoint, &memory->weights, &memory->most,   &memory->scales,
                                   &memory->moments, &memory->slopes,  &memory->around, &memory->first_around,
                                   &memory->lengths, &memory->faces,   &memory->node,   &memory->of_rays,
                                   &memory->wanted,  &memory->lines};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
    skg_free(&memory->reals);
    skg_free(&memory->corners);
    skg_free(&memory->planes);
    skg_free(&memory->versions);
    skg_free(&memory->wanted_now);
    skg_free(&memory);
}

static int64_t bytes(const void *of) {
    const skg_gradient_memory *memory = of;
    return memory->adjoint.bytes + memory->weights.bytes + memory->most.bytes + memory->scales.bytes +
           memory->moments.bytes + memory->slopes.bytes + memory->lengths.bytes + memory->faces.bytes +
           memory->node.bytes + memory->around.bytes + memory->first_around.bytes + memory->of_rays.bytes +
           memory->wanted.bytes + memory->lines.bytes;
}

skg_status skg_gradient_memory_get(skg_machine *machine, skg_gradient_memory **memory) {
    skg_attachment *attached = &machine->attached;
    *memory = attached->memory;
    if (*memory) return SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof **memory, "gradient", memory));
    *attached = (skg_attachment){.memory = *memory, .release = release, .bytes = bytes};
    return SKG_OK;
}
