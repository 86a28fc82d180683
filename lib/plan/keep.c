#include "plan/keep.h"

#include "beam/bowtie.h"
#include "beam/grid.h"

#include <string.h>

static skg_status keep_bowtie(const skg_bowtie *given, skg_kept *kept) {
    skg_bowtie ours;
    skg_bowtie_init(&ours);
    SKG_TRY(skg_struct_read(given, "skg_bowtie", &ours, sizeof ours));
    SKG_TRY(skg_bowtie_check(&ours));
    SKG_TRY(skg_alloc(2 * ours.count, sizeof *kept->rows, "bow-tie", &kept->rows));
    memcpy(kept->rows, ours.angle_deg, (size_t)ours.count * sizeof *kept->rows);
    memcpy(kept->rows + ours.count, ours.path_mm, (size_t)ours.count * sizeof *kept->rows);
    ours.angle_deg = kept->rows, ours.path_mm = kept->rows + ours.count;
    skg_material_retain(ours.material);
    kept->bowtie = ours;
    return SKG_OK;
}

static skg_status keep_grid(const skg_grid *given, skg_kept *kept) {
    skg_grid ours;
    skg_grid_init(&ours);
    SKG_TRY(skg_struct_read(given, "skg_grid", &ours, sizeof ours));
    SKG_TRY(skg_grid_check(&ours));
    if (ours.strip) skg_material_retain(ours.strip);
    if (ours.interspace) skg_material_retain(ours.interspace);
    kept->grid = ours;
    return SKG_OK;
}

skg_status skg_keep(skg_plan_options *options, skg_kept *kept) {
    const skg_heel *heel = options->heel;
    const skg_bowtie *bowtie = options->bowtie;
    const skg_grid *grid = options->grid;
    options->heel = NULL, options->bowtie = NULL, options->grid = NULL;
    skg_heel_init(&kept->heel);
    if (heel) SKG_TRY(skg_struct_read(heel, "skg_heel", &kept->heel, sizeof kept->heel));
    if (bowtie) SKG_TRY(keep_bowtie(bowtie, kept));
    if (grid) SKG_TRY(keep_grid(grid, kept));
    if (heel) options->heel = &kept->heel;
    if (bowtie) options->bowtie = &kept->bowtie;
    if (grid) options->grid = &kept->grid;
    return SKG_OK;
}

void skg_kept_release(skg_kept *kept) {
    skg_material_release(&kept->bowtie.material);
    skg_material_release(&kept->grid.strip);
    skg_material_release(&kept->grid.interspace);
    skg_free(&kept->rows);
}
