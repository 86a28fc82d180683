/* Rough cells: blocks of cells, each with one mixture, as a first guess of what photons pass. */
#include "scatter/planting.h"

#include "skg_shared.h"

/* The mean mixture of a block of cells. Returns whether they are not all of one medium. */
static int mix_block(const skg_planting *p, const int64_t block[3], double mean[SKG_SCATTER_RANK]) {
    const skg_cells *cells = p->cells;
    int64_t first[3], end[3], count = 1;
    int mixed = 0;
    for (int k = 0; k < 3; k++) {
        first[k] = block[k] * SKG_CELL_ROUGH, end[k] = first[k] + SKG_CELL_ROUGH;
        if (end[k] > cells->count[k]) end[k] = cells->count[k];
        count *= end[k] - first[k];
    }
    const uint32_t word = p->tree.of[(first[2] * cells->count[1] + first[1]) * cells->count[0] + first[0]];
    for (int k = 0; k < SKG_SCATTER_RANK; k++) mean[k] = 0;
    for (int64_t z = first[2]; z < end[2]; z++)
        for (int64_t y = first[1]; y < end[1]; y++)
            for (int64_t x = first[0]; x < end[0]; x++) {
                const int64_t c = (z * cells->count[1] + y) * cells->count[0] + x;
                mixed |= p->tree.of[c] != word || SKG_CELL_KIND(word) != SKG_CELL_MEDIUM;
                for (int k = 0; k < SKG_SCATTER_RANK; k++)
                    mean[k] += (double)cells->mixtures[c][k] / (double)count;
            }
    return mixed;
}

skg_status skg_plant_rough(skg_planting *p) {
    int64_t count[3];
    int mixed = 0;
    if (p->has_rough) return SKG_OK;
    p->has_rough = 1;
    for (int k = 0; k < 3; k++) count[k] = (p->cells->count[k] + SKG_CELL_ROUGH - 1) / SKG_CELL_ROUGH;
    p->cells->rough = (uint32_t)p->media.count;
    for (int64_t c = 0; c < count[0] * count[1] * count[2]; c++) {
        const int64_t block[3] = {c % count[0], c / count[0] % count[1], c / count[0] / count[1]};
        double mean[SKG_SCATTER_RANK];
        skg_mixture mixture;
        uint32_t medium = 0;
        mixed |= mix_block(p, block, mean);
        for (int k = 0; k < SKG_SCATTER_RANK; k++) mixture[k] = (float)mean[k];
        SKG_TRY(skg_media_add(&p->media, mixture, &medium));
    }
    if (!mixed) p->cells->rough = 0;
    return SKG_OK;
}
