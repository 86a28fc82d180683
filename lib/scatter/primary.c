/* Error of the cells: photons that scatter once straight on, through the cells against through the surfaces, on a coarse grid of the
 * detector. It shows the bias of cells that are too large for thin or small parts. Batches share the cells, so their spread does not show
 * this bias. */
#include "scatter/voxels.h"

#include "core/maths.h"
#include "core/threads.h"

#include <math.h>

/* RAYS x RAYS rays, about two for a cell, in blocks of BLOCK x BLOCK, large enough that edges which cells blur without a bias count
 * little. */
enum { RAYS = 96, BLOCK = 8, BLOCKS = RAYS / BLOCK };

/* Ways through the parts. */
enum { CELLS, SURFACES, MATERIALS, ROUGH, WAYS };

struct skg_judging {
    skg_cell_parts parts; /* in columns, rows and depths, but for volumes */
    skg_solid *solids;
    double *positions;
    int32_t *sign;
    skg_cell_amount *amounts[2]; /* of coefficients; of lines */
    const skg_view *view;
    const skg_cells *cells;
    skg_column_rows *rows;
    skg_columns grid;    /* in columns, rows and depths */
    double direction[3]; /* of parallel rays */
    int is_point;
    int32_t turn; /* -1: columns, rows and depths are a mirrored frame */
    const skg_beam_lines *lines;
    double mu[SKG_SCATTER_RANK][SKG_SCATTER_RANK]; /* [lines] 1/mm per coefficient */
    double (*sent)[WAYS]; /* [RAYS * RAYS] of the energy; NULL: a part reaches behind the source */
};
typedef skg_judging judge;

/* --- rays */

/* A place of a ray is on + t * way. */
typedef struct {
    double on[3], way[3];
} ray;

static ray ray_at(const judge *j, double column, double row) {
    const skg_view *view = j->view;
    ray r;
    for (int k = 0; k < 3; k++) {
        const double pixel = view->centre[k] +
                             (column - 0.5 * (double)(view->columns - 1)) * view->column_step[k] +
                             (row - 0.5 * (double)(view->rows - 1)) * view->row_step[k];
        r.on[k] = j->is_point ? view->source[k] : pixel;
        r.way[k] = j->is_point ? pixel - view->source[k] : j->direction[k];
    }
    return r;
}

/* Depths keep planes flat: -1 / t of a point source, t of parallel rays. */
static double way_to(const judge *j, double depth) {
    return j->is_point ? -1 / depth : depth;
}

/* Puts places of the world into columns, rows and depths. Returns 0 if one is not in front of the source. */
static int project(const judge *j, int64_t count, const double *from, double *to) {
    const skg_view *view = j->view;
    double normal[3], across[2][3];
    skg_cross(view->column_step, view->row_step, normal);
    const double *const way = j->direction; /* of a point source: to the detector's centre */
    const double reach = skg_dot(way, normal);
    skg_cross(view->row_step, normal, across[0]);
    skg_cross(normal, view->column_step, across[1]);
    for (int k = 0; k < 2; k++)
        skg_scale_vector(1 / skg_dot(across[k], k ? view->row_step : view->column_step), across[k],
                         across[k]);
    for (int64_t i = 0; i < count; i++) {
        double off[3], on_detector[3];
        skg_add_scaled(from + 3 * i, -1, j->is_point ? view->source : view->centre, off);
        const double t = skg_dot(off, normal) / reach;
        if (j->is_point && !(t > 1e-6)) return 0;
        for (int k = 0; k < 3; k++) on_detector[k] = j->is_point ? off[k] / t - way[k] : off[k] - t * way[k];
        to[3 * i] = 0.5 * (double)(view->columns - 1) + skg_dot(on_detector, across[0]);
        to[3 * i + 1] = 0.5 * (double)(view->rows - 1) + skg_dot(on_detector, across[1]);
        to[3 * i + 2] = j->is_point ? -1 / t : t;
    }
    return 1;
}

/* --- both ways */

/* mm of each coefficient along a ray. */
typedef struct {
    const judge *j;
    double length; /* of ray.way */
    double mm[SKG_SCATTER_RANK];
    const ray *along;
    double from;     /* where the ray enters the cells */
    int exact;       /* 1: lines; 0: coefficients */
    double *amounts; /* [skg_cell_curves] workspace */
} sum;

/* From a depth on a volume of cells is there `times` times. */
static void add_volume(sum *s, const skg_cell_volume *volume, double depth, double times) {
    const double to = way_to(s->j, depth);
    double ends[2][3], through[SKG_SCATTER_RANK] = {0};
    if (times == 0 || !(to > s->from)) return;
    for (int k = 0; k < 3; k++) {
        ends[0][k] = s->along->on[k] + s->from * s->along->way[k];
        ends[1][k] = s->along->on[k] + to * s->along->way[k];
    }
    skg_volume_between(volume, s->exact, ends[0], ends[1], s->amounts, through);
    for (int k = 0; k < SKG_SCATTER_RANK; k++) s->mm[k] -= times * through[k] * (to - s->from) * s->length;
}

static void add_change(void *user, double depth, const int64_t *more, int64_t factor) {
    sum *s = user;
    const double mm = (double)factor * s->length * way_to(s->j, depth) / SKG_CELL_UNIT;
    for (int k = 0; k < SKG_SCATTER_RANK; k++) s->mm[k] -= (double)more[k] * mm;
    for (int64_t v = 0; v < s->j->parts.volume_count; v++)
        add_volume(s, &s->j->parts.volumes[v], depth,
                   (double)(factor * more[SKG_CELL_TIMES + v]) / SKG_CELL_UNIT);
}

/* Sum over the beam's lines of weight t exp(-t), with depth[e] the optical depth t of line e: proportional to the energy that scatters once
 * straight on and passes. */
static double sent_by(const judge *j, const double depth[SKG_SCATTER_RANK]) {
    double sent = 0;
    for (int64_t e = 0; e < j->lines->count; e++)
        if (depth[e] > 0) sent += j->lines->weight[e] * depth[e] * exp(-depth[e]);
    return sent;
}

static double sent_by_mixed(const judge *j, const double mm[SKG_SCATTER_RANK]) {
    double depth[SKG_SCATTER_RANK] = {0};
    for (int64_t e = 0; e < j->lines->count; e++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++) depth[e] += j->mu[e][k] * mm[k];
    return sent_by(j, depth);
}

/* The stretch of a ray within the box of the cells. Returns 0 if there is none. */
static int enter(const skg_cells *cells, const ray *r, double *from, double *to) {
    *from = -HUGE_VAL, *to = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double a = (cells->low[k] - r->on[k]) / r->way[k],
                     b = (cells->low[k] + cells->size[k] - r->on[k]) / r->way[k];
        if (r->way[k] == 0 && !(r->on[k] > cells->low[k] && r->on[k] < cells->low[k] + cells->size[k]))
            return 0;
        if (r->way[k] == 0) continue;
        *from = fmax(*from, fmin(a, b)), *to = fmin(*to, fmax(a, b));
    }
    return *to > *from;
}

/* A row of rays through the surfaces. */
static skg_status walk_surfaces(void *user, int64_t row) {
    judge *j = user;
    skg_columns grid = j->grid;
    int64_t *work = NULL;
    double *amounts = NULL;
    skg_status status = SKG_OK;
    grid.first_row = row;
    grid.rows = 1;
    SKG_TRY_CLEANUP(skg_alloc(skg_cell_curves(&j->parts), sizeof *amounts, "cells", &amounts));
    SKG_TRY_CLEANUP(skg_alloc(2 * j->parts.count, sizeof *work, "cells", &work));
    SKG_TRY_CLEANUP(skg_columns_gather(&grid, j->parts.count, j->parts.solids, j->rows));
    for (int64_t c = 0; c < RAYS; c++) {
        const ray r = ray_at(j, skg_column_place(&grid, 0, c), skg_column_place(&grid, 1, row));
        double from, to;
        if (!enter(j->cells, &r, &from, &to)) continue;
        for (int exact = 0; exact < 2; exact++) {
            const double *base = exact ? j->lines->world : j->parts.base;
            sum s = {.j = j,
                     .length = skg_length(r.way),
                     .along = &r,
                     .from = from,
                     .exact = exact,
                     .amounts = amounts};
            skg_cells_walk(&j->parts, (const skg_cell_amount *)j->amounts[exact], &grid, c, work, add_change,
                           &s);
            for (int k = 0; k < SKG_SCATTER_RANK && base; k++) s.mm[k] += base[k] * (to - from) * s.length;
            j->sent[row * RAYS + c][exact ? MATERIALS : SURFACES] =
                exact ? sent_by(j, s.mm) : sent_by_mixed(j, s.mm);
        }
    }
cleanup:
    skg_columns_free(&grid);
    skg_free(&work);
    skg_free(&amounts);
    return status;
}

/* A row of rays through the cells. */
static skg_status walk_cells(void *user, int64_t row) {
    judge *j = user;
    for (int64_t c = 0; c < RAYS; c++) {
        const ray r = ray_at(j, skg_column_place(&j->grid, 0, c), skg_column_place(&j->grid, 1, row));
        double from, to, ends[2][3], mm[SKG_SCATTER_RANK], *sent = j->sent[row * RAYS + c];
        if (!enter(j->cells, &r, &from, &to)) continue;
        for (int k = 0; k < 3; k++) {
            ends[0][k] = r.on[k] + from * r.way[k] - j->cells->low[k];
            ends[1][k] = r.on[k] + to * r.way[k] - j->cells->low[k];
        }
        skg_cells_along(j->cells, ends[0], ends[1], mm);
        sent[CELLS] = sent_by_mixed(j, mm);
        skg_cells_roughly(j->cells, ends[0], ends[1], mm);
        sent[ROUGH] = sent_by_mixed(j, mm);
    }
    return SKG_OK;
}

/* --- the beam, and the verdict */

/* 1/mm per coefficient at the lines. */
static void find_coefficients(const skg_scatter_physics *physics, judge *j) {
    const double points = (double)(physics->energies - 1);
    for (int64_t e = 0; e < j->lines->count; e++) {
        const double at = fmin(fmax(points * log(j->lines->kev[e] / physics->low_kev) /
                                        log(physics->high_kev / physics->low_kev),
                                    0),
                               points);
        const int64_t i = (int64_t)fmin(at, points - 1);
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            j->mu[e][k] = (1 - (at - (double)i)) * (double)physics->total[i][k] +
                          (at - (double)i) * (double)physics->total[i + 1][k];
    }
}

/* How far the cells are from one of the ways through surfaces. */
static double verdict(const judge *j, int way) {
    double off = 0, all = 0;
    for (int b = 0; b < BLOCKS * BLOCKS; b++) {
        double difference = 0;
        for (int i = 0; i < BLOCK * BLOCK; i++) {
            const double *sent =
                j->sent[(b / BLOCKS * BLOCK + i / BLOCK) * RAYS + b % BLOCKS * BLOCK + i % BLOCK];
            difference += sent[CELLS] - sent[way];
            all += sent[way];
        }
        off += fabs(difference);
    }
    return all > 0 ? off / all : 0;
}

/* How far rays through rough cells are from those through the cells, in the root mean square. */
static double spread(const judge *j) {
    double off = 0, all = 0;
    for (int i = 0; i < RAYS * RAYS; i++) {
        off += pow(j->sent[i][ROUGH] - j->sent[i][CELLS], 2);
        all += pow(j->sent[i][CELLS], 2);
    }
    return all > 0 ? sqrt(off / all) : 0;
}

/* The solids in columns, rows and depths, and the signs of their hits there. *in_front: 0 if one reaches behind the source. */
static skg_status project_solids(const skg_cell_parts *parts, judge *j, int *in_front) {
    int64_t vertices = 0;
    for (int64_t p = 0; p < parts->count; p++) vertices += parts->solids[p].vertices;
    SKG_TRY(skg_alloc(parts->count, sizeof *j->solids, "cells", &j->solids));
    SKG_TRY(skg_alloc(parts->count, sizeof *j->sign, "cells", &j->sign));
    SKG_TRY(skg_alloc(3 * vertices, sizeof *j->positions, "cells", &j->positions));
    *in_front = 1;
    double *to = j->positions;
    for (int64_t p = 0; p < parts->count && *in_front; p++) {
        j->solids[p] = parts->solids[p];
        j->sign[p] = j->turn * parts->sign[p];
        *in_front = project(j, j->solids[p].vertices, j->solids[p].positions, to);
        j->solids[p].positions = to;
        to += 3 * j->solids[p].vertices;
    }
    j->parts.solids = j->solids, j->parts.sign = j->sign;
    return SKG_OK;
}

static void find_frame(judge *j) {
    const skg_view *view = j->view;
    double normal[3];
    j->is_point = view->projection == SKG_PROJECTION_POINT;
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(1, view->source, j->direction);
    else
        skg_add_scaled(view->centre, -1, view->source, j->direction);
    skg_cross(view->column_step, view->row_step, normal);
    j->turn = skg_dot(normal, j->direction) < 0 ? -1 : 1;
    j->grid.side = RAYS;
    for (int k = 0; k < 2; k++) {
        j->grid.low[k] = -0.5;
        j->grid.step[k] = (double)(k ? view->rows : view->columns) / RAYS;
    }
}

static skg_status find_amounts(const skg_cell_parts *parts, judge *j) {
    skg_cell_parts exact = *parts;
    exact.coefficients = j->lines->parts;
    SKG_TRY(skg_cells_amounts(parts, &j->amounts[0]));
    return skg_cells_amounts(&exact, &j->amounts[1]);
}

skg_status skg_judging_begin(const skg_cell_parts *parts, const skg_scatter_physics *physics,
                             const skg_beam_lines *lines, const skg_view *view, const skg_cells *cells,
                             skg_judging **judging) {
    int in_front = 0;
    judge *j = NULL;
    *judging = NULL;
    if (!cells->mixtures) return SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *j, "cells", &j));
    *j = (judge){.view = view, .cells = cells, .lines = lines, .parts = *parts};
    *judging = j;
    find_frame(j);
    SKG_TRY(project_solids(parts, j, &in_front));
    if (!in_front) return SKG_OK;
    SKG_TRY(find_amounts(parts, j));
    find_coefficients(physics, j);
    SKG_TRY(skg_alloc(RAYS * RAYS, sizeof *j->sent, "cells", &j->sent));
    j->grid.rows = RAYS;
    SKG_TRY(skg_columns_span(&j->grid, parts->count, j->solids, &j->rows));
    return skg_parallel(RAYS, walk_surfaces, j);
}

skg_status skg_judging_of(skg_judging *j, skg_judged *judged) {
    *judged = (skg_judged){0};
    if (!j || !j->sent) return SKG_OK;
    SKG_TRY(skg_parallel(RAYS, walk_cells, j));
    judged->cells = verdict(j, SURFACES);
    judged->all = verdict(j, MATERIALS);
    judged->rough = spread(j);
    return SKG_OK;
}

void skg_judging_end(skg_judging **judging) {
    judge *j = *judging;
    if (!j) return;
    skg_free(&j->solids);
    skg_free(&j->sign);
    skg_free(&j->positions);
    skg_free(&j->amounts[0]);
    skg_free(&j->amounts[1]);
    skg_free(&j->rows);
    skg_free(&j->sent);
    skg_free(judging);
}
