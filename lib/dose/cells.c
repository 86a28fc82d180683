/* Lines through volumes of cells: pieces in which the cells are the same. */
#include "dose/pieces.h"

#include "core/maths.h"
#include "scene/scene.h"
#include "scene/volume.h"

#include <string.h>

/* A line among the cells of a volume, and where it stands. */
typedef struct {
    const skg_volume *volume;
    double from[3], way[3]; /* in cells, of a mm */
    double next[3];         /* mm to the next plane across each axis */
    int64_t cell[3];
} cell_line;

static void find_plane(cell_line *line, int axis) {
    const int64_t plane = line->cell[axis] + (line->way[axis] > 0);
    line->next[axis] = line->way[axis] > 0 || line->way[axis] < 0
                           ? ((double)plane - line->from[axis]) / line->way[axis]
                           : HUGE_VAL;
}

/* at: mm along the line, where it is in the box but for rounding */
static void begin(const skg_scene_part_data *part, const double from[3], const double direction[3], double at,
                  cell_line *line) {
    double m[16];
    line->volume = part->volume;
    skg_volume_to_cells(part->volume, part->pose, m);
    for (int k = 0; k < 3; k++) {
        line->way[k] = skg_dot(m + 4 * k, direction);
        line->from[k] = skg_dot(m + 4 * k, from) + m[4 * k + 3];
        const double place = line->from[k] + at * line->way[k];
        const double cell = line->way[k] < 0 ? ceil(place) - 1 : floor(place);
        line->cell[k] = (int64_t)fmin(fmax(cell, 0), (double)(line->volume->size[k] - 1));
        find_plane(line, k);
    }
}

/* Into the cell behind a plane. The last one goes on to the end of the piece, which rounding may put behind the box. */
static void pass(cell_line *line, int axis) {
    const int64_t cell = line->cell[axis] + (line->way[axis] > 0 ? 1 : -1);
    if (cell < 0 || cell >= line->volume->size[axis]) {
        line->next[axis] = HUGE_VAL;
        return;
    }
    line->cell[axis] = cell;
    find_plane(line, axis);
}

static int32_t curve_at(const cell_line *line, double *amount) {
    const int64_t *size = line->volume->size, *cell = line->cell;
    return skg_volume_cell(line->volume, (cell[2] * size[1] + cell[1]) * size[0] + cell[0], amount);
}

/* A part of a piece, in which the presence of the volume is that of cells of one kind. */
static skg_status add_part(skg_way *way, const skg_piece *piece, int64_t of_volume,
                           const skg_presence *cells) {
    SKG_TRY(skg_way_add_piece(way, piece->from, piece->to));
    for (int64_t k = piece->first; k < piece->first + piece->count; k++) {
        const skg_presence presence = k == of_volume ? *cells : way->presences[k];
        SKG_TRY(skg_way_add_presence(way, &presence));
    }
    return SKG_OK;
}

static skg_status cut(skg_way *way, skg_piece piece, int64_t of_volume, cell_line *line) {
    const skg_presence whole = way->presences[of_volume];
    const double end = piece.to;
    double amount = 0, next = 0;
    skg_presence cells = {whole.part, curve_at(line, &amount), 0};
    for (;;) {
        int axis = line->next[1] < line->next[0] ? 1 : 0;
        if (line->next[2] < line->next[axis]) axis = 2;
        const double until = line->next[axis];
        if (!(until < end)) break;
        pass(line, axis);
        const int32_t curve = curve_at(line, &next);
        if (until > piece.from && (curve != cells.curve || next < amount || next > amount)) {
            piece.to = until, cells.share = whole.share * amount;
            SKG_TRY(add_part(way, &piece, of_volume, &cells));
            piece.from = until;
        }
        cells.curve = curve, amount = next;
    }
    piece.to = end, cells.share = whole.share * amount;
    return add_part(way, &piece, of_volume, &cells);
}

/* Behind the pieces come those in which the cells of one part are cut; then they take their place. */
static skg_status cut_part(const skg_rules *rules, int64_t part, const double from[3],
                           const double direction[3], skg_way *way) {
    const int64_t count = way->piece_count;
    for (int64_t i = 0; i < count; i++) {
        const skg_piece piece = way->pieces[i];
        cell_line line;
        int64_t k = piece.first;
        while (k < piece.first + piece.count && way->presences[k].part != part) k++;
        if (k == piece.first + piece.count) {
            SKG_TRY(add_part(way, &piece, -1, NULL));
            continue;
        }
        begin(&rules->scene->parts[part], from, direction, piece.from, &line);
        SKG_TRY(cut(way, piece, k, &line));
    }
    way->piece_count -= count;
    memmove(way->pieces, way->pieces + count, (size_t)way->piece_count * sizeof *way->pieces);
    return SKG_OK;
}

skg_status skg_way_find_cells(const skg_forest *tree, const skg_rules *rules, const double from[3],
                              const double direction[3], double reach, skg_way *way) {
    SKG_TRY(skg_way_find(tree, rules, from, direction, reach, way));
    for (int64_t p = 0; rules->cells && p < rules->scene->count; p++)
        if (rules->scene->parts[p].volume) SKG_TRY(cut_part(rules, p, from, direction, way));
    return SKG_OK;
}
