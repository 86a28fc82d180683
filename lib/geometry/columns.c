#include "geometry/columns.h"

#include "core/parallel.h"
#include "core/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns are off the corner of their cell by an irrational part of it (the square roots of 3 and 2 less 1), so that
 * faces along the axes and shared vertices are rarely met exactly. Where they are, the half-open rule below still
 * balances the hits. */
double skg_column_place(const skg_columns *grid, int axis, int64_t index) {
    return grid->low[axis] +
           ((double)index + (axis ? 0.4142135623730951 : 0.7320508075688772)) * grid->step[axis];
}

/* The x at which the edge from a to b crosses y. The end with the lower y comes first, so that both triangles at
 * an edge get the same bits. */
static double crossing(const double *a, const double *b, double y) {
    if (a[1] > b[1] || (a[1] == b[1] && a[0] > b[0])) {
        const double *swap = a;
        a = b, b = swap;
    }
    return a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
}

/* The hits in the order in which they are found. */
typedef struct {
    skg_column_hit hit;
    int64_t cell;
} found_hit;

typedef struct {
    const skg_columns *grid;
    const double *places[2]; /* [side] of each axis: skg_column_place */
    double inverse[2];       /* 1 / step */
    int64_t count, capacity;
    found_hit *found;
} search;

/* Makes room for the hits of one row. */
static skg_status reserve_row(search *s) {
    if (s->count + s->grid->side <= s->capacity) return SKG_OK;
    const int64_t more = 2 * s->capacity + 4 * s->grid->side;
    SKG_TRY(skg_realloc(more, sizeof *s->found, "overlap hits", &s->found));
    s->capacity = more;
    return SKG_OK;
}

/* The first column at or behind a place; the number of columns if all are before it. */
static int64_t first_behind(const search *s, int axis, double place) {
    const double index = (place - s->grid->low[axis]) * s->inverse[axis];
    int64_t k = index > 1 ? (index < (double)s->grid->side ? (int64_t)index - 1 : s->grid->side) : 0;
    while (k < s->grid->side && s->places[axis][k] < place) k++;
    return k;
}

/* Where a triangle's plane is: a corner, and how its depth falls along x and y. */
typedef struct {
    const double *corner;
    double fall[2];
} plane;

/* Adds the hits of a row, which crosses the triangle at x[0] and x[1]. */
static skg_status add_row(search *s, int32_t part, const plane *face, int64_t row, const double x[2],
                          const int downward[2]) {
    const int first = x[0] <= x[1] ? 0 : 1;
    const double *places = s->places[0], *a = face->corner;
    const double along = (s->places[1][row] - a[1]) * face->fall[1];
    SKG_TRY(reserve_row(s));
    for (int64_t column = first_behind(s, 0, x[first]); column < s->grid->side; column++) {
        if (places[column] >= x[1 - first]) break;
        const double depth = a[2] - ((places[column] - a[0]) * face->fall[0] + along);
        /* With a normal against +z the triangle is clockwise in x and y: the first crossing runs up, and the ray
         * enters. */
        s->found[s->count++] =
            (found_hit){{depth, part, downward[first] ? -1 : 1}, row * s->grid->side + column};
    }
    return SKG_OK;
}

static double least(double a, double b, double c) {
    const double ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* Whether a triangle lies beside all columns. Crossings are rounded, which is far below the step that is allowed for. */
static int misses(const search *s, const double *a, const double *b, const double *c, double lo, double hi) {
    const int64_t last = s->grid->side - 1;
    if (!(lo <= s->places[1][last] && hi > s->places[1][0])) return 1;
    const double left = least(a[0], b[0], c[0]), right = -least(-a[0], -b[0], -c[0]);
    return left > s->places[0][last] + s->grid->step[0] || right < s->places[0][0] - s->grid->step[0];
}

/* Adds the hits of one triangle by the scan-crossing rule of the kernels, in double. */
static skg_status add_triangle(search *s, int32_t part, const double *a, const double *b, const double *c) {
    const double *p[3] = {a, b, c};
    const double lo = least(a[1], b[1], c[1]), hi = -least(-a[1], -b[1], -c[1]);
    double ab[3], ac[3], normal[3];
    if (misses(s, a, b, c, lo, hi)) return SKG_OK;
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_cross(ab, ac, normal);
    const int slanted = normal[2] != 0;
    const plane face = {a, {slanted ? normal[0] / normal[2] : 0, slanted ? normal[1] / normal[2] : 0}};
    for (int64_t row = first_behind(s, 1, lo); row < s->grid->side && s->places[1][row] < hi; row++) {
        const double y = s->places[1][row];
        double x[2];
        int found = 0, downward[2];
        for (int e = 0; e < 3 && found < 2; e++) {
            const double *from = p[e], *to = p[(e + 1) % 3];
            if ((from[1] <= y) == (to[1] <= y)) continue;
            downward[found] = from[1] > to[1];
            x[found++] = crossing(from, to, y);
        }
        if (found == 2) SKG_TRY(add_row(s, part, &face, row, x, downward));
    }
    return SKG_OK;
}

/* What threads share: the triangles of all solids, in pieces. */
typedef struct {
    int64_t count, triangles;
    const skg_solid *solids;
    search *pieces; /* [grid->pieces] */
} gathering;

static skg_status gather_piece(void *user, int64_t piece) {
    const gathering *g = user;
    search *s = &g->pieces[piece];
    int64_t first = piece * g->triangles / s->grid->pieces,
            end = (piece + 1) * g->triangles / s->grid->pieces;
    for (int64_t i = 0; i < g->count && end > 0; i++) {
        const skg_solid *solid = &g->solids[i];
        const double *at = solid->positions;
        for (int64_t t = first; t < end && t < solid->triangles; t++) {
            const int32_t *corner = solid->corners + 3 * t;
            SKG_TRY(add_triangle(s, (int32_t)i, at + 3 * (int64_t)corner[0], at + 3 * (int64_t)corner[1],
                                 at + 3 * (int64_t)corner[2]));
        }
        first = first > solid->triangles ? first - solid->triangles : 0;
        end -= solid->triangles;
    }
    return SKG_OK;
}

/* Sorts the hits by cell: those of column c are from grid->first[c] to grid->first[c + 1] - 1. */
static skg_status sort_by_cell(const search *pieces, skg_columns *grid) {
    const int64_t cells = grid->side * grid->side;
    int64_t count = 0;
    for (int64_t k = 0; k < grid->pieces; k++) count += pieces[k].count;
    SKG_TRY(skg_alloc(cells + 2, sizeof *grid->first, "overlap columns", &grid->first));
    SKG_TRY(skg_alloc(count, sizeof *grid->hits, "overlap hits", &grid->hits));
    /* Counts are stored two places on, so that first[c + 1] is where cell c begins when the cells are filled. */
    for (int64_t k = 0; k < grid->pieces; k++)
        for (int64_t i = 0; i < pieces[k].count; i++) grid->first[pieces[k].found[i].cell + 2]++;
    for (int64_t c = 0; c < cells; c++) grid->first[c + 2] += grid->first[c + 1];
    for (int64_t k = 0; k < grid->pieces; k++)
        for (int64_t i = 0; i < pieces[k].count; i++)
            grid->hits[grid->first[pieces[k].found[i].cell + 1]++] = pieces[k].found[i].hit;
    return SKG_OK;
}

skg_status skg_columns_gather(skg_columns *grid, int64_t count, const skg_solid *solids) {
    gathering g = {.count = count, .solids = solids};
    double *places = NULL;
    skg_status status = SKG_OK;
    for (int64_t i = 0; i < count; i++) g.triangles += solids[i].triangles;
    SKG_TRY(skg_alloc(grid->pieces, sizeof *g.pieces, "overlap hits", &g.pieces));
    SKG_TRY_CLEANUP(skg_alloc(2 * grid->side, sizeof *places, "overlap columns", &places));
    for (int64_t i = 0; i < 2 * grid->side; i++)
        places[i] = skg_column_place(grid, (int)(i / grid->side), i % grid->side);
    for (int64_t k = 0; k < grid->pieces; k++)
        g.pieces[k] = (search){.grid = grid,
                               .places = {places, places + grid->side},
                               .inverse = {1 / grid->step[0], 1 / grid->step[1]}};
    SKG_TRY_CLEANUP(skg_parallel(grid->pieces, gather_piece, &g));
    SKG_TRY_CLEANUP(sort_by_cell(g.pieces, grid));
cleanup:
    for (int64_t k = 0; k < grid->pieces; k++) skg_free(&g.pieces[k].found);
    skg_free(&g.pieces);
    skg_free(&places);
    return status;
}

void skg_columns_bound(skg_columns *grid, int64_t count, const skg_solid *solids) {
    for (int k = 0; k < 3; k++) grid->low[k] = HUGE_VAL, grid->high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < count; i++)
        for (int64_t v = 0; solids[i].triangles > 0 && v < 3 * solids[i].vertices; v++) {
            const double x = solids[i].positions[v];
            if (x < grid->low[v % 3]) grid->low[v % 3] = x;
            if (x > grid->high[v % 3]) grid->high[v % 3] = x;
        }
    for (int k = 0; k < 2; k++) grid->step[k] = (grid->high[k] - grid->low[k]) / (double)grid->side;
}

static int by_depth(const void *a, const void *b) {
    const skg_column_hit *left = a, *right = b;
    if (left->depth != right->depth) return left->depth < right->depth ? -1 : 1;
    /* At touching surfaces the ray leaves one part before it enters the other, so that they do not overlap. */
    if (left->sign != right->sign) return left->sign < right->sign ? -1 : 1;
    return left->part < right->part ? -1 : left->part > right->part;
}

/* Most columns have a few hits, for which an insertion sort takes less than a call of qsort. */
void skg_columns_sort(skg_columns *grid, int64_t cell) {
    enum { FEW = 48 };
    skg_column_hit *hit = grid->hits + grid->first[cell];
    const int64_t count = grid->first[cell + 1] - grid->first[cell];
    if (count > FEW) {
        qsort(hit, (size_t)count, sizeof *hit, by_depth);
        return;
    }
    for (int64_t i = 1; i < count; i++) {
        const skg_column_hit moving = hit[i];
        int64_t k = i;
        for (; k > 0 && by_depth(&hit[k - 1], &moving) > 0; k--) hit[k] = hit[k - 1];
        hit[k] = moving;
    }
}

void skg_columns_free(skg_columns *grid) {
    skg_free(&grid->first);
    skg_free(&grid->hits);
}
