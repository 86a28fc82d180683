/* One pass of a frame. */
#include "stage/pass.h"

skg_status skg_pass_memory_create(int64_t parts, int64_t columns, int64_t rows, skg_pass_memory *memory) {
    *memory = (skg_pass_memory){0};
    SKG_TRY(skg_alloc(parts, sizeof *memory->parts, "parts of a frame", &memory->parts));
    SKG_TRY(skg_alloc(parts, sizeof *memory->extents, "parts of a frame", &memory->extents));
    SKG_TRY(skg_alloc(parts, sizeof *memory->scales, "parts of a frame", &memory->scales));
    SKG_TRY(skg_alloc(parts, sizeof *memory->touching, "parts of a frame", &memory->touching));
    SKG_TRY(skg_alloc(parts, sizeof *memory->groups, "parts of a frame", &memory->groups));
    SKG_TRY(skg_alloc(parts, sizeof *memory->group_of, "parts of a frame", &memory->group_of));
    SKG_TRY(skg_alloc(parts, sizeof *memory->poses, "parts of a frame", &memory->poses));
    SKG_TRY(skg_alloc(parts, sizeof *memory->versions, "parts of a frame", &memory->versions));
    return skg_scale_grid_create(columns, rows, &memory->grid);
}

void skg_pass_memory_release(skg_pass_memory *memory) {
    skg_free(&memory->parts);
    skg_free(&memory->extents);
    skg_free(&memory->scales);
    skg_free(&memory->touching);
    skg_free(&memory->groups);
    skg_free(&memory->group_of);
    skg_free(&memory->poses);
    skg_free(&memory->versions);
    skg_scale_grid_release(&memory->grid);
}

void skg_pass_release(skg_pass *pass) {
    skg_free(&pass->own_contributions);
    skg_free(&pass->own_first);
    skg_mix_release(&pass->mix);
    skg_priority_release(&pass->priority);
    skg_raster_pin_release(&pass->main);
}
