/* Columns through meshes along an axis, and what they meet. */
#include "geometry/overlaps.h"

#include "core/maths.h"
#include "core/threads.h"

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

/* The hits in the order in which they are found. */
typedef struct {
    double depth;
    int32_t part, sign;
    int64_t cell;
} found_hit;

typedef struct {
    const skg_columns *grid;
    double *places[2]; /* [side] of each axis: skg_column_place */
    double inverse[2]; /* 1 / step */
    int64_t count, capacity;
    found_hit *found;
} search;

static skg_status open_search(const skg_columns *grid, search *s) {
    *s = (search){.grid = grid, .inverse = {1 / grid->step[0], 1 / grid->step[1]}};
    SKG_TRY(skg_alloc(2 * grid->side, sizeof *s->places[0], "overlap columns", &s->places[0]));
    s->places[1] = s->places[0] + grid->side;
    for (int64_t i = 0; i < 2 * grid->side; i++)
        s->places[0][i] = skg_column_place(grid, (int)(i / grid->side), i % grid->side);
    return SKG_OK;
}

static void close_search(search *s) {
    skg_free(&s->places[0]);
    skg_free(&s->found);
}

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
    const double index = (place - s->places[axis][0]) * s->inverse[axis];
    int64_t k = index > 0 ? (index < (double)s->grid->side ? (int64_t)index : s->grid->side) : 0;
    while (k > 0 && s->places[axis][k - 1] >= place) k--; /* index is rounded */
    while (k < s->grid->side && s->places[axis][k] < place) k++;
    return k;
}

static double least(double a, double b, double c) {
    const double ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* The corners of a triangle. */
static void find_corners(const skg_solid *solid, int64_t triangle, const double *p[3]) {
    for (int k = 0; k < 3; k++) p[k] = solid->positions + 3 * (int64_t)solid->corners[3 * triangle + k];
}

/* The rows that meet a triangle; none if it lies beside all columns. Crossings are rounded, which is far below the step that
 * is allowed for. */
static skg_column_rows rows_of(const search *s, const double *const p[3]) {
    const double *a = p[0], *b = p[1], *c = p[2], *step = s->grid->step;
    const int64_t last = s->grid->side - 1;
    const double left = least(a[0], b[0], c[0]), right = -least(-a[0], -b[0], -c[0]);
    if (left > s->places[0][last] + step[0] || right < s->places[0][0] - step[0])
        return (skg_column_rows){0, 0};
    const int64_t first = first_behind(s, 1, least(a[1], b[1], c[1]));
    const int64_t end = first_behind(s, 1, -least(-a[1], -b[1], -c[1]));
    return (skg_column_rows){(uint16_t)first, (uint16_t)end};
}

/* Where a triangle's plane is: a corner, and how its depth falls along x and y. */
typedef struct {
    const double *corner;
    double fall[2];
} plane;

/* An edge of a triangle from the end with the lower y, so that both triangles at the edge get the same bits. */
typedef struct {
    double low, high; /* y */
    double x, slope;  /* at the lower end; dx/dy */
    int downward;     /* 1: the triangle runs along it towards the lower end */
} slanted_edge;

/* Edges that are not along x. Returns how many there are. */
static int find_edges(const double *const p[3], slanted_edge edges[3]) {
    int count = 0;
    for (int e = 0; e < 3; e++) {
        const double *from = p[e], *to = p[(e + 1) % 3];
        const int downward = from[1] > to[1];
        const double *low = downward ? to : from, *high = downward ? from : to;
        if (low[1] == high[1]) continue;
        edges[count++] =
            (slanted_edge){low[1], high[1], low[0], (high[0] - low[0]) / (high[1] - low[1]), downward};
    }
    return count;
}

/* Adds the hits of a row, which crosses the triangle at x[0] and x[1]. */
static skg_status add_row(search *s, int32_t part, const plane *face, int64_t row, const double x[2],
                          const int downward[2]) {
    const int first = x[0] <= x[1] ? 0 : 1;
    const double *places = s->places[0], *a = face->corner;
    const double along = (s->places[1][row] - a[1]) * face->fall[1];
    /* With a normal against +z the triangle is clockwise in x and y: the first crossing runs up, and the ray enters. */
    const int32_t sign = downward[first] ? -1 : 1;
    SKG_TRY(reserve_row(s));
    for (int64_t column = first_behind(s, 0, x[first]); column < s->grid->side; column++) {
        if (places[column] >= x[1 - first]) break;
        const double depth = a[2] - ((places[column] - a[0]) * face->fall[0] + along);
        s->found[s->count++] =
            (found_hit){depth, part, sign, (row - s->grid->first_row) * s->grid->side + column};
    }
    return SKG_OK;
}

/* Adds the hits of one triangle in these rows by the scan-crossing rule of the kernels, in double. */
static skg_status add_triangle(search *s, int32_t part, const double *const p[3], int64_t row, int64_t end) {
    double ab[3], ac[3], normal[3];
    slanted_edge edges[3];
    skg_add_scaled(p[1], -1, p[0], ab);
    skg_add_scaled(p[2], -1, p[0], ac);
    skg_cross(ab, ac, normal);
    const int slanted = normal[2] != 0, count = find_edges(p, edges);
    const plane face = {p[0], {slanted ? normal[0] / normal[2] : 0, slanted ? normal[1] / normal[2] : 0}};
    for (; row < end; row++) {
        const double y = s->places[1][row];
        double x[2];
        int found = 0, downward[2];
        for (int e = 0; e < count && found < 2; e++) {
            if (!(edges[e].low <= y && y < edges[e].high)) continue;
            downward[found] = edges[e].downward;
            x[found++] = edges[e].x + (y - edges[e].low) * edges[e].slope;
        }
        if (found == 2) SKG_TRY(add_row(s, part, &face, row, x, downward));
    }
    return SKG_OK;
}

static skg_status find_hits(search *s, int64_t count, const skg_solid *solids, const skg_column_rows *rows) {
    const int64_t first = s->grid->first_row, end = first + s->grid->rows;
    int64_t number = 0; /* of the triangle, through all solids */
    for (int64_t i = 0; i < count; i++)
        for (int64_t t = 0; t < solids[i].triangles; t++, number++) {
            const double *p[3];
            if (rows && (rows[number].first >= end || rows[number].end <= first)) continue;
            find_corners(&solids[i], t, p);
            const skg_column_rows met = rows ? rows[number] : rows_of(s, p);
            SKG_TRY(add_triangle(s, (int32_t)i, p, met.first > first ? met.first : first,
                                 met.end < end ? met.end : end));
        }
    return SKG_OK;
}

/* Sorts the hits by cell: those of column c are from grid->first[c] to grid->first[c + 1] - 1. */
static skg_status sort_by_cell(const search *s, skg_columns *grid) {
    const int64_t cells = grid->rows * grid->side;
    SKG_TRY(skg_alloc(cells + 2, sizeof *grid->first, "overlap columns", &grid->first));
    SKG_TRY(skg_alloc(s->count, sizeof *grid->hits, "overlap hits", &grid->hits));
    /* Counts are stored two places on, so that first[c + 1] is where cell c begins when the cells are filled. */
    for (int64_t i = 0; i < s->count; i++) grid->first[s->found[i].cell + 2]++;
    for (int64_t c = 0; c < cells; c++) grid->first[c + 2] += grid->first[c + 1];
    for (int64_t i = 0; i < s->count; i++) {
        const found_hit *found = &s->found[i];
        grid->hits[grid->first[found->cell + 1]++] = (skg_column_hit){found->depth, found->part, found->sign};
    }
    return SKG_OK;
}

skg_status skg_columns_gather(skg_columns *grid, int64_t count, const skg_solid *solids,
                              const skg_column_rows *rows) {
    search s;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(open_search(grid, &s));
    SKG_TRY_CLEANUP(find_hits(&s, count, solids, rows));
    SKG_TRY_CLEANUP(sort_by_cell(&s, grid));
cleanup:
    close_search(&s);
    return status;
}

/* Work of the threads: the triangles of all solids, in pieces. */
enum { PIECE = 4096 };
typedef struct {
    int64_t count;
    const skg_solid *solids;
    const search *search;
    skg_column_rows *rows;
} spanning;

static skg_status span_piece(void *user, int64_t piece) {
    const spanning *span = user;
    int64_t before = 0; /* triangles of the solids so far */
    for (int64_t i = 0; i < span->count; i++) {
        const skg_solid *solid = &span->solids[i];
        const int64_t from = piece * PIECE - before, to = from + PIECE;
        for (int64_t t = from > 0 ? from : 0; t < to && t < solid->triangles; t++) {
            const double *p[3];
            find_corners(solid, t, p);
            span->rows[before + t] = rows_of(span->search, p);
        }
        before += solid->triangles;
    }
    return SKG_OK;
}

skg_status skg_columns_span(const skg_columns *grid, int64_t count, const skg_solid *solids,
                            skg_column_rows **rows) {
    search s;
    int64_t triangles = 0;
    skg_status status = SKG_OK;
    *rows = NULL;
    for (int64_t i = 0; i < count; i++) triangles += solids[i].triangles;
    SKG_TRY_CLEANUP(open_search(grid, &s));
    SKG_TRY_CLEANUP(skg_alloc(triangles, sizeof **rows, "overlap columns", rows));
    spanning span = {count, solids, &s, *rows};
    SKG_TRY_CLEANUP(skg_parallel((triangles + PIECE - 1) / PIECE, span_piece, &span));
cleanup:
    close_search(&s);
    if (status != SKG_OK) skg_free(rows);
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

double skg_columns_hits_estimate(const skg_columns *grid, int64_t count, const skg_solid *solids) {
    double twice = 0; /* mm2 */
    for (int64_t i = 0; i < count; i++)
        for (int64_t t = 0; t < solids[i].triangles; t++) {
            const double *p[3];
            find_corners(&solids[i], t, p);
            twice +=
                fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
        }
    return 0.5 * twice / (grid->step[0] * grid->step[1]);
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
