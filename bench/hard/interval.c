/* The interval of lengths that rays around a pixel have. */
#include "hard/interval.h"

#include "support/caster.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
    double a[2], b[2]; /* column and row of its ends */
    int32_t from, to;  /* vertices, from < to */
} edge;

/* Triangles near the pixel: few of many. */
typedef struct {
    const skg_view *view;
    double middle[2], shift;
    solid near;
    double *places; /* [vertices][2] of `near` */
    edge *edges;
    int64_t edge_count;
    double *rows, *columns; /* to be sorted */
    int64_t row_count, row_capacity;
    caster *caster;
    double work; /* triangles that may still be looked at */
    hard_interval *found;
} neighbourhood;

/* Where a cell is looked at, as shares of its width: its ends, from inside, and its middle. */
enum { LOOKS = 3 };
static const double looks[LOOKS] = {0.5, 1e-5, 1 - 1e-5};

static void place_of(const skg_view *view, const double *p, double at[2]) {
    const double depth = (p[2] - view->source[2]) / (view->centre[2] - view->source[2]);
    const double scale = view->projection == SKG_PROJECTION_POINT ? depth : 1;
    at[0] = p[0] / (scale * view->column_step[0]) + 0.5 * (double)(view->columns - 1);
    at[1] = p[1] / (scale * view->row_step[1]) + 0.5 * (double)(view->rows - 1);
}

/* The rows of pixels within half a pixel of a triangle: from, to (exclusive). */
static void rows_of(const hard_sight *sight, int64_t triangle, int64_t *from, int64_t *to) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    const double last = (double)sight->view->rows - 1;
    for (int k = 0; k < 3; k++) {
        const double row = sight->places[2 * (int64_t)sight->of->corners[3 * triangle + k] + 1];
        low = row < low ? row : low;
        high = row > high ? row : high;
    }
    *from = (int64_t)fmax(0, fmin(last + 1, ceil(low - 0.5)));
    *to = (int64_t)fmax(0, fmin(last, floor(high + 0.5)) + 1);
}

hard_sight hard_see(const solid *s, const skg_view *view) {
    hard_sight sight = {.of = s, .view = view};
    sight.places = calloc((size_t)(2 * s->vertices), sizeof *sight.places);
    sight.first = calloc((size_t)(view->rows + 2), sizeof *sight.first);
    for (int64_t v = 0; v < s->vertices; v++) place_of(view, s->positions + 3 * v, sight.places + 2 * v);
    int64_t from = 0, to = 0;
    for (int64_t t = 0; t < s->triangles; t++) {
        rows_of(&sight, t, &from, &to);
        for (int64_t row = from; row < to; row++) sight.first[row + 2]++;
    }
    for (int64_t row = 0; row < view->rows; row++) sight.first[row + 2] += sight.first[row + 1];
    sight.list = calloc((size_t)(sight.first[view->rows + 1] + 1), sizeof *sight.list);
    for (int64_t t = 0; t < s->triangles; t++) {
        rows_of(&sight, t, &from, &to);
        for (int64_t row = from; row < to; row++) sight.list[sight.first[row + 1]++] = (int32_t)t;
    }
    return sight;
}

void hard_sight_free(hard_sight *sight) {
    free(sight->places);
    free(sight->first);
    free(sight->list);
    *sight = (hard_sight){0};
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int by_vertices(const void *a, const void *b) {
    const edge *x = a, *y = b;
    return x->from != y->from ? (x->from > y->from) - (x->from < y->from) : (x->to > y->to) - (x->to < y->to);
}

/* Whether the box around the triangle meets the square. */
static int is_near(const neighbourhood *n, const double *a, const double *b, const double *c) {
    for (int k = 0; k < 2; k++)
        if (fmin(a[k], fmin(b[k], c[k])) > n->middle[k] + n->shift ||
            fmax(a[k], fmax(b[k], c[k])) < n->middle[k] - n->shift)
            return 0;
    return 1;
}

/* The number of vertex `old` among those near. */
static int32_t take_vertex(neighbourhood *n, const hard_sight *sight, int32_t old, int32_t *numbers) {
    if (!numbers[old]) {
        const int64_t v = n->near.vertices++;
        for (int k = 0; k < 3; k++) n->near.positions[3 * v + k] = sight->of->positions[3 * (int64_t)old + k];
        for (int k = 0; k < 2; k++) n->places[2 * v + k] = sight->places[2 * (int64_t)old + k];
        numbers[old] = (int32_t)n->near.vertices;
    }
    return numbers[old] - 1;
}

static void take_triangles(neighbourhood *n, const hard_sight *sight, int64_t row) {
    int32_t *numbers = calloc((size_t)sight->of->vertices, sizeof *numbers); /* from 1; 0: not near */
    int64_t capacity = 0;
    for (int64_t k = sight->first[row]; k < sight->first[row + 1]; k++) {
        const int32_t *corner = sight->of->corners + 3 * (int64_t)sight->list[k];
        if (!is_near(n, sight->places + 2 * (int64_t)corner[0], sight->places + 2 * (int64_t)corner[1],
                     sight->places + 2 * (int64_t)corner[2]))
            continue;
        if (n->near.triangles == capacity) {
            capacity = 2 * capacity + 16;
            n->near.corners = realloc(n->near.corners, (size_t)(3 * capacity) * sizeof *n->near.corners);
            n->near.positions =
                realloc(n->near.positions, (size_t)(9 * capacity) * sizeof *n->near.positions);
            n->places = realloc(n->places, (size_t)(6 * capacity) * sizeof *n->places);
        }
        for (int c = 0; c < 3; c++)
            n->near.corners[3 * n->near.triangles + c] = take_vertex(n, sight, corner[c], numbers);
        n->near.triangles++;
    }
    free(numbers);
}

static void take_edges(neighbourhood *n) {
    const int64_t sides = 3 * n->near.triangles;
    n->edges = calloc((size_t)(sides + 1), sizeof *n->edges);
    for (int64_t e = 0; e < sides; e++) {
        const int32_t p = n->near.corners[e], q = n->near.corners[e % 3 == 2 ? e - 2 : e + 1];
        const int32_t from = p < q ? p : q, to = p < q ? q : p;
        const double *a = n->places + 2 * (int64_t)from, *b = n->places + 2 * (int64_t)to;
        n->edges[e] = (edge){{a[0], a[1]}, {b[0], b[1]}, from, to};
    }
    qsort(n->edges, (size_t)sides, sizeof *n->edges, by_vertices);
    for (int64_t e = 0; e < sides; e++)
        if (n->edge_count == 0 || by_vertices(&n->edges[e], &n->edges[n->edge_count - 1]) != 0)
            n->edges[n->edge_count++] = n->edges[e];
    n->columns = calloc((size_t)(n->edge_count + 2), sizeof *n->columns);
}

/* A corner of a triangle as seen: column, row, depth. */
typedef struct {
    double at[3];
} corner;

/* Cuts off what lies beyond a side of the square: axis 0 or 1, way -1 or 1. Returns the number of corners that are left. */
static int cut(const corner *from, int count, int axis, double way, double limit, corner *to) {
    int left = 0;
    for (int k = 0; k < count; k++) {
        const corner *a = &from[k], *b = &from[(k + 1) % count];
        const double da = limit - way * a->at[axis], db = limit - way * b->at[axis];
        if (da >= 0) to[left++] = *a;
        if ((da >= 0) == (db >= 0)) continue;
        for (int c = 0; c < 3; c++) to[left].at[c] = a->at[c] + da / (da - db) * (b->at[c] - a->at[c]);
        left++;
    }
    return left;
}

/* The depths of a face within the square. 0: it does not meet it. */
static int depths_of(const neighbourhood *n, int64_t triangle, double *nearest, double *farthest) {
    corner given[8], other[8]; /* a triangle that four sides have cut has at most seven corners */
    int count = 3;
    for (int k = 0; k < 3; k++) {
        const int64_t v = n->near.corners[3 * triangle + k];
        given[k] = (corner){{n->places[2 * v], n->places[2 * v + 1], n->near.positions[3 * v + 2]}};
    }
    for (int axis = 0; axis < 2; axis++) {
        count = cut(given, count, axis, 1, n->middle[axis] + n->shift, other);
        count = cut(other, count, axis, -1, n->shift - n->middle[axis], given);
    }
    *nearest = HUGE_VAL, *farthest = -HUGE_VAL;
    for (int k = 0; k < count; k++) {
        *nearest = fmin(*nearest, given[k].at[2]);
        *farthest = fmax(*farthest, given[k].at[2]);
    }
    return count > 0;
}

/* Length of the ray to the middle per mm of depth. */
static double slant(const neighbourhood *n) {
    const skg_view *view = n->view;
    if (view->projection != SKG_PROJECTION_POINT) return 1;
    const double way = view->centre[2] - view->source[2];
    const double x = (n->middle[0] - 0.5 * (double)(view->columns - 1)) * view->column_step[0] / way;
    const double y = (n->middle[1] - 0.5 * (double)(view->rows - 1)) * view->row_step[1] / way;
    return sqrt(1 + x * x + y * y);
}

/* Faces that change their depth by more than `change` mm within the square. */
static void find_steep(const neighbourhood *n, double change) {
    double nearest, farthest;
    n->found->nearest = HUGE_VAL, n->found->farthest = -HUGE_VAL;
    for (int64_t t = 0; t < n->near.triangles; t++) {
        if (!depths_of(n, t, &nearest, &farthest) || farthest - nearest <= change) continue;
        n->found->steep_faces++;
        n->found->nearest = fmin(n->found->nearest, slant(n) * nearest);
        n->found->farthest = fmax(n->found->farthest, slant(n) * farthest);
    }
}

/* A row at which the order of the crossings may change, if it is within the square. */
static void add_row(neighbourhood *n, double row) {
    if (!(fabs(row - n->middle[1]) <= n->shift)) return;
    if (n->row_count == n->row_capacity) {
        n->row_capacity = 2 * n->row_capacity + 16;
        n->rows = realloc(n->rows, (size_t)n->row_capacity * sizeof *n->rows);
    }
    n->rows[n->row_count++] = row;
}

/* Rows of corners, and of places where two edges cross. */
static void find_rows(neighbourhood *n) {
    add_row(n, n->middle[1] - n->shift);
    add_row(n, n->middle[1] + n->shift);
    for (int64_t v = 0; v < n->near.vertices; v++) add_row(n, n->places[2 * v + 1]);
    for (int64_t e = 0; e < n->edge_count; e++)
        for (int64_t f = 0; f < e; f++) {
            const edge *p = &n->edges[e], *q = &n->edges[f];
            if (p->from == q->from || p->from == q->to || p->to == q->from || p->to == q->to) continue;
            const double u[2] = {p->b[0] - p->a[0], p->b[1] - p->a[1]},
                         w[2] = {q->b[0] - q->a[0], q->b[1] - q->a[1]};
            const double across = u[0] * w[1] - u[1] * w[0];
            const double along = ((q->a[0] - p->a[0]) * w[1] - (q->a[1] - p->a[1]) * w[0]) / across;
            if (along >= 0 && along <= 1) add_row(n, p->a[1] + along * u[1]);
        }
    qsort(n->rows, (size_t)n->row_count, sizeof *n->rows, ascending);
}

static void widen(const neighbourhood *n, double column, double row) {
    const double length = (double)caster_length(n->caster, n->view, (long double)column, (long double)row);
    if (length < n->found->low || isnan(length)) n->found->low = length;
    if (length > n->found->high || isnan(length)) n->found->high = length;
}

/* The cells of one row, or about `most` of them. */
static void look_along(neighbourhood *n, double row, int64_t most) {
    int64_t count = 0;
    n->columns[count++] = n->middle[0] - n->shift;
    n->columns[count++] = n->middle[0] + n->shift;
    for (int64_t e = 0; e < n->edge_count; e++) {
        const edge *p = &n->edges[e];
        if ((p->a[1] < row) == (p->b[1] < row)) continue;
        const double x = p->a[0] + (row - p->a[1]) / (p->b[1] - p->a[1]) * (p->b[0] - p->a[0]);
        if (fabs(x - n->middle[0]) < n->shift) n->columns[count++] = x;
    }
    qsort(n->columns, (size_t)count, sizeof *n->columns, ascending);
    const int64_t stride = count / most + 1;
    for (int64_t k = 0; k + 1 < count; k += stride)
        for (int at = 0; at < LOOKS; at++)
            widen(n, n->columns[k] + looks[at] * (n->columns[k + 1] - n->columns[k]), row);
}

double hard_distance(const hard_interval *interval, double got) {
    return fmax(0, fmax(interval->low - got, got - interval->high));
}

/* Looks at cells until `got` is found or the work is done. */
static void search(neighbourhood *n, double got, double slack) {
    const double rays = n->work / (double)(n->near.triangles + n->near.vertices + 1);
    const int64_t cells = n->row_count - 1, most = (int64_t)sqrt(rays / (LOOKS * LOOKS)) + 1;
    const int64_t stride = cells / most + 1;
    for (int at = 0; at < LOOKS; at++)
        for (int64_t k = 0; k < cells && hard_distance(n->found, got) > slack; k += stride)
            look_along(n, n->rows[k] + looks[at] * (n->rows[k + 1] - n->rows[k]), most);
}

hard_interval hard_interval_of(const hard_sight *sight, int64_t column, int64_t row, double shift,
                               double longest, double got, double slack, double work) {
    hard_interval found = {.low = HUGE_VAL, .high = -HUGE_VAL};
    neighbourhood n = {.view = sight->view, .shift = shift, .work = work, .found = &found};
    n.middle[0] = (double)column, n.middle[1] = (double)row;
    take_triangles(&n, sight, row);
    take_edges(&n);
    find_steep(&n, 1e-6 * longest);
    n.caster = caster_create(&n.near, NULL);
    widen(&n, n.middle[0], n.middle[1]);
    if (hard_distance(&found, got) > slack) {
        find_rows(&n);
        search(&n, got, slack);
    }
    caster_free(n.caster);
    solid_free(&n.near);
    free(n.places);
    free(n.edges);
    free(n.rows);
    free(n.columns);
    return found;
}
