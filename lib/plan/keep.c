#include "plan/keep.h"

#include "beam/bowtie.h"
#include "beam/grid.h"

#include <inttypes.h>
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

static skg_status keep_depths(const skg_depth_blur *given, skg_kept *kept) {
    skg_depth_blur ours;
    double before = 0;
    skg_depth_blur_init(&ours);
    SKG_TRY(skg_struct_read(given, "skg_depth_blur", &ours, sizeof ours));
    if (ours.count < 1 || ours.count > SKG_DEPTHS_MAX || !ours.to || !ours.blur)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%" PRId64 " depths of a scintillator; 1 to %d, with ends and blurs", ours.count,
                        (int)SKG_DEPTHS_MAX);
    for (int64_t d = 0; d < ours.count; d++) {
        if (!(ours.to[d] > before && ours.to[d] <= 1) || (d == ours.count - 1 && ours.to[d] < 1))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "depth %" PRId64
                            " of the scintillator ends at %g of its thickness; ends rise, and the "
                            "last is 1",
                            d + 1, ours.to[d]);
        before = kept->depth_ends[d] = ours.to[d];
    }
    ours.to = kept->depth_ends;
    ours.blur = NULL;
    kept->depths = ours;
    return SKG_OK;
}

static skg_status keep_dqe(const skg_dqe *given, skg_kept *kept) {
    skg_dqe ours;
    skg_dqe_init(&ours);
    SKG_TRY(skg_struct_read(given, "skg_dqe", &ours, sizeof ours));
    if (ours.count < 2 || !ours.per_mm || !ours.dqe)
        return skg_fail(SKG_ERR_ARGUMENT, "a table of the DQE has at least two frequencies");
    for (int64_t i = 0; i < ours.count; i++)
        if (!(ours.dqe[i] > 0 && ours.dqe[i] <= 1))
            return skg_fail(SKG_ERR_ARGUMENT, "DQE, row %" PRId64 ": %g; give more than 0, up to 1", i + 1,
                            ours.dqe[i]);
    SKG_TRY(skg_alloc(2 * ours.count, sizeof *kept->frequencies, "DQE", &kept->frequencies));
    memcpy(kept->frequencies, ours.per_mm, (size_t)ours.count * sizeof *kept->frequencies);
    memcpy(kept->frequencies + ours.count, ours.dqe, (size_t)ours.count * sizeof *kept->frequencies);
    ours.per_mm = kept->frequencies, ours.dqe = kept->frequencies + ours.count;
    kept->dqe = ours;
    return SKG_OK;
}

skg_status skg_keep(skg_plan_options *options, skg_kept *kept) {
    const skg_heel *heel = options->heel;
    const skg_bowtie *bowtie = options->bowtie;
    const skg_grid *grid = options->grid;
    const skg_depth_blur *depths = options->depth_blur;
    const skg_dqe *dqe = options->dqe;
    options->heel = NULL, options->bowtie = NULL, options->grid = NULL;
    options->depth_blur = NULL, options->dqe = NULL;
    skg_heel_init(&kept->heel);
    if (heel) SKG_TRY(skg_struct_read(heel, "skg_heel", &kept->heel, sizeof kept->heel));
    if (bowtie) SKG_TRY(keep_bowtie(bowtie, kept));
    if (grid) SKG_TRY(keep_grid(grid, kept));
    if (depths && options->blur)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "each depth of the scintillator has a blur of its own; leave out the one for all");
    if (depths) SKG_TRY(keep_depths(depths, kept));
    if (dqe) SKG_TRY(keep_dqe(dqe, kept));
    if (heel) options->heel = &kept->heel;
    if (bowtie) options->bowtie = &kept->bowtie;
    if (grid) options->grid = &kept->grid;
    if (depths) options->depth_blur = &kept->depths;
    if (dqe) options->dqe = &kept->dqe;
    return SKG_OK;
}

void skg_kept_release(skg_kept *kept) {
    skg_material_release(&kept->bowtie.material);
    skg_material_release(&kept->grid.strip);
    skg_material_release(&kept->grid.interspace);
    skg_free(&kept->rows);
    skg_free(&kept->frequencies);
}
