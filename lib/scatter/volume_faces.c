/* Faces at which volumes of cells begin or end: what they add differs from cell to cell of the object. */
#include "scatter/planting.h"

#include <string.h>

static int changes(const skg_planting *p, int64_t face) {
    int some = 0;
    for (int64_t v = 0; v < p->parts->volume_count; v++)
        some |= p->parts->volumes[v].times[p->part[face]] != 0;
    return some;
}

/* Where a part leaves the box of a volume, what its faces add is not the same on both sides of the box. */
static void settle(skg_planting *p, int64_t cell) {
    for (int64_t v = 0; v < p->parts->volume_count; v++) {
        int box = 0, other = 0;
        for (int64_t i = p->first[cell]; i < p->first[cell + 1]; i++) {
            const int32_t times = p->parts->volumes[v].times[p->part[p->faces_of[i]]];
            box |= times > 0;
            other |= times < 0;
        }
        if (box && other) p->settled[cell] = 1;
    }
}

/* The medium that faces of a part add in a cell. */
static skg_status add_medium(skg_planting *p, int64_t cell, int32_t part, uint32_t *number) {
    skg_cell_amount all;
    skg_mixture more;
    skg_cell_all(p->cells, cell, p->amounts[part], all);
    for (int k = 0; k < SKG_SCATTER_RANK; k++) more[k] = (float)((double)all[k] / SKG_CELL_UNIT);
    return skg_media_add(&p->media, more, number);
}

/* Puts copies in the place of faces. Those of a part stand behind each other in the list of a cell, and share a medium. */
static skg_status copy(skg_planting *p, int64_t cell, int64_t *next) {
    int32_t part = -1;
    uint32_t medium = 0;
    for (int64_t i = p->first[cell]; i < p->first[cell + 1]; i++) {
        const int64_t face = p->faces_of[i];
        if (!changes(p, face)) continue;
        if (p->part[face] != part) {
            part = p->part[face];
            SKG_TRY(add_medium(p, cell, part, &medium));
        }
        memcpy(p->corners[*next], p->corners[face], sizeof *p->corners);
        p->part[*next] = part;
        p->own[*next - p->originals] = medium;
        p->faces_of[i] = (uint32_t)(*next)++;
    }
    return SKG_OK;
}

skg_status skg_plant_copies(skg_planting *p) {
    const int64_t cells = skg_cells_count(p->cells);
    int64_t copies = 0, next = p->originals;
    for (int64_t i = 0; i < p->first[cells]; i++) copies += changes(p, p->faces_of[i]);
    SKG_TRY(skg_realloc(p->originals + copies, sizeof *p->corners, "cells", &p->corners));
    SKG_TRY(skg_realloc(p->originals + copies, sizeof *p->part, "cells", &p->part));
    SKG_TRY(skg_alloc(copies + 1, sizeof *p->own, "cells", &p->own));
    for (int64_t c = 0; c < cells; c++) {
        settle(p, c);
        SKG_TRY(copy(p, c, &next));
    }
    p->face_count = next;
    return SKG_OK;
}
