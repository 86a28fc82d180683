/* Copies of what the caller's options point to. */
#include "plan/inputs.h"

#include <string.h>

typedef struct skg_copy {
    void *memory;
    skg_material *material;
} skg_copy;

static skg_status append(skg_copies *copies, skg_copy copy) {
    SKG_TRY(skg_realloc(copies->count + 1, sizeof *copies->copies, "options of a plan", &copies->copies));
    copies->copies[copies->count++] = copy;
    return SKG_OK;
}

skg_status skg_copies_alloc(skg_copies *copies, int64_t count, size_t size, const char *what,
                            void *pointer_address) {
    void *memory = NULL;
    SKG_TRY(skg_alloc(count, size, what, &memory));
    const skg_status status = append(copies, (skg_copy){.memory = memory});
    if (status != SKG_OK) skg_free(&memory);
    memcpy(pointer_address, &memory, sizeof memory);
    return status;
}

skg_status skg_copies_struct(skg_copies *copies, const void *given, const char *name, size_t size,
                             void (*init_sized)(void *, int32_t), void *pointer_address) {
    void *ours = NULL;
    SKG_TRY(skg_copies_alloc(copies, 1, size, name, &ours));
    init_sized(ours, (int32_t)size);
    SKG_TRY(skg_struct_read(given, name, ours, size));
    memcpy(pointer_address, &ours, sizeof ours);
    return SKG_OK;
}

skg_status skg_copies_array(skg_copies *copies, int64_t count, const char *what, const double **values) {
    double *ours = NULL;
    SKG_TRY(skg_copies_alloc(copies, count, sizeof *ours, what, &ours));
    memcpy(ours, *values, (size_t)count * sizeof *ours);
    *values = ours;
    return SKG_OK;
}

skg_status skg_copies_material(skg_copies *copies, skg_material *material) {
    if (!material) return SKG_OK;
    SKG_TRY(append(copies, (skg_copy){.material = material}));
    skg_material_retain(material);
    return SKG_OK;
}

void skg_copies_release(skg_copies *copies) {
    for (int64_t i = 0; i < copies->count; i++) {
        skg_free(&copies->copies[i].memory);
        skg_material_release(&copies->copies[i].material);
    }
    skg_free(&copies->copies);
    copies->count = 0;
}
