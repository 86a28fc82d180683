/* Counts what a frame of a scene consists of, by calls of the public interface. */
#include "scaling/prediction.h"

#include <math.h>
#include <stdlib.h>

enum { PLANES = 64 };

/* Column, row and path parameter of a point: solves point = source + t (first pixel - source + i column + j row). */
static void see(const skg_view *v, const double *point, double *seen) {
    double m[3][3], d[3], r[3];
    for (int k = 0; k < 3; k++) {
        const double pixel = v->centre[k] - v->column_step[k] * (double)(v->columns - 1) / 2 -
                             v->row_step[k] * (double)(v->rows - 1) / 2;
        m[0][k] = v->column_step[k], m[1][k] = v->row_step[k], m[2][k] = pixel - v->source[k];
        d[k] = point[k] - v->source[k];
    }
    for (int k = 0; k < 3; k++) {
        const double *a = m[(k + 1) % 3], *b = m[(k + 2) % 3];
        const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        r[k] = (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) / (n[0] * m[k][0] + n[1] * m[k][1] + n[2] * m[k][2]);
    }
    seen[0] = r[0] / r[2], seen[1] = r[1] / r[2], seen[2] = r[2];
}

/* Vector additions that a worker draws a box with (kernels/raster/draw.clh): four triangles of at most 2 x 2 pixels in one
 * vector; blocks of four columns; whole rows; or what lies in the triangle, in pieces of a row. */
static double vectors_of(double columns, double rows, double hits) {
    if (columns <= 2 && rows <= 2) return 4.0 / SCALING_LANES;
    if (columns <= 4) return ceil(rows / (SCALING_LANES / 4.0));
    if (columns <= 2 * SCALING_LANES) return rows * ceil(columns / SCALING_LANES);
    return rows * ceil(hits / rows / SCALING_LANES);
}

static void count_triangle(const double *a, const double *b, const double *c, int planes, const skg_view *v,
                           scaling_counts *out, double *warp) {
    const double area = fabs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
    const double left = fmax(ceil(fmin(a[0], fmin(b[0], c[0]))), 0),
                 top = fmax(ceil(fmin(a[1], fmin(b[1], c[1]))), 0);
    const double columns = fmin(ceil(fmax(a[0], fmax(b[0], c[0]))), (double)v->columns) - left;
    const double rows = fmin(ceil(fmax(a[1], fmax(b[1], c[1]))), (double)v->rows) - top;
    if ((int64_t)out->triangles % SCALING_WARP == 0) out->warps += SCALING_WARP * *warp, *warp = 0;
    scaling_triangle *t = &out->list[(int64_t)out->triangles++];
    if (planes)
        out->hits += area, out->adds += area * planes; /* small ones hit by chance: on average their area */
    if (columns <= 0 || rows <= 0 || !planes) return;
    t->top = top, t->bottom = top + rows, t->box = columns * rows;
    t->vectors = vectors_of(columns, rows, fmin(area, t->box)) * planes;
    out->vectors += t->vectors;
    if (t->box > SCALING_LARGE_BOX)
        out->warps += t->box;
    else
        *warp = fmax(*warp, t->box);
}

/* Contributions that an accumulator holds: of all parts, of one material, or of one kind. */
typedef enum { ALL, MATERIALS, KINDS } meaning;

/* Materials of an accumulator's parts, and of their parents. */
typedef struct {
    const void *own, *parent;
} kind;

static int accumulator_of(kind wanted, kind *kinds) {
    int k = 0;
    while (kinds[k].own && (kinds[k].own != wanted.own || kinds[k].parent != wanted.parent) && k < PLANES - 1)
        k++;
    kinds[k] = wanted;
    return k;
}

/* Accumulators that a part adds to: one if there is no other; that of its kind, if planes are mixed from them; else that of its
 * own material and of its parent's. */
static int accumulators_of(const skg_scene *scene, const skg_part *part, meaning of, kind *kinds,
                           int *where) {
    skg_part parent;
    int count = 0;
    skg_part_init(&parent);
    if (part->inside >= 0) bench_try(skg_scene_part_get(scene, part->inside, &parent), "parent");
    if (of == ALL) return where[0] = 0, 1;
    if (part->inside >= 0 && parent.material == part->material) return 0;
    if (of == KINDS) return where[0] = accumulator_of((kind){part->material, parent.material}, kinds), 1;
    where[count++] = accumulator_of((kind){part->material, NULL}, kinds);
    if (part->inside >= 0) where[count++] = accumulator_of((kind){parent.material, NULL}, kinds);
    return count;
}

static void count_part(const skg_part *part, const skg_view *v, const int *where, int planes,
                       double (*extents)[4], scaling_counts *out) {
    int64_t vertices = 0, triangles = 0;
    double warp = 0;
    bench_try(skg_mesh_count(part->mesh, &vertices, &triangles), "mesh");
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    double *positions = bench_alloc((size_t)(3 * vertices), sizeof *positions), point[3];
    int32_t *corners = bench_alloc((size_t)(3 * triangles), sizeof *corners);
    bench_try(skg_mesh_positions_get(part->mesh, positions, 0), "positions");
    bench_try(skg_mesh_triangles_get(part->mesh, corners, 0), "triangles");
    for (int64_t k = 0; k < vertices; k++) {
        double *p = positions + 3 * k;
        for (int r = 0; r < 3; r++)
            point[r] = part->pose[4 * r] * p[0] + part->pose[4 * r + 1] * p[1] +
                       part->pose[4 * r + 2] * p[2] + part->pose[4 * r + 3];
        see(v, point, p);
        for (int i = 0; i < 2; i++) low[i] = fmin(low[i], p[i]), high[i] = fmax(high[i], p[i]);
    }
    const double width = fmin(high[0], (double)v->columns) - fmax(low[0], 0);
    const double height = fmin(high[1], (double)v->rows) - fmax(low[1], 0);
    if (width > 0 && height > 0) out->rectangles += width * height;
    for (int e = 0; e < planes; e++)
        for (int i = 0; i < 2; i++) {
            extents[where[e]][2 * i] = fmin(extents[where[e]][2 * i], low[i]);
            extents[where[e]][2 * i + 1] = fmax(extents[where[e]][2 * i + 1], high[i]);
        }
    for (int64_t k = 0; k < triangles; k++)
        count_triangle(positions + 3 * corners[3 * k], positions + 3 * corners[3 * k + 1],
                       positions + 3 * corners[3 * k + 2], planes, v, out, &warp);
    out->vertices += (double)vertices;
    free(positions), free(corners);
}

scaling_counts scaling_count(const bench_scene *scene, const skg_plan_report *report) {
    const skg_view *v = &scene->view;
    const meaning of = report->accumulators == 1 || report->accumulators > PLANES ? ALL
                       : report->accumulators == report->planes                   ? MATERIALS
                                                                                  : KINDS;
    kind kinds[PLANES] = {{NULL, NULL}};
    double extents[PLANES][4];
    int64_t parts = 0;
    scaling_counts c = {
        .rows = v->rows, .pixels = (double)(v->rows * v->columns), .nodes = (double)report->nodes};
    const int64_t row =
        (v->columns + 16 + 15) / 16 * 16 * report->plane_bits / 8; /* 16: columns beyond the detector */
    c.planes = (double)report->planes, c.accumulators = (double)report->accumulators,
    c.row_bytes = row * report->accumulators;
    c.image_bytes = c.rows * c.row_bytes;
    c.list = bench_alloc((size_t)report->triangles, sizeof *c.list);
    for (int p = 0; p < PLANES; p++)
        for (int k = 0; k < 4; k++) extents[p][k] = k % 2 ? -HUGE_VAL : HUGE_VAL;
    bench_try(skg_scene_part_count(scene->scene, &parts), "scene");
    for (int64_t k = 0; k < parts; k++) {
        skg_part part;
        int where[2] = {0, 0};
        skg_part_init(&part);
        bench_try(skg_scene_part_get(scene->scene, k, &part), "part");
        const int planes = accumulators_of(scene->scene, &part, of, kinds, where);
        count_part(&part, v, where, planes, extents, &c);
    }
    for (int p = 0; p < (of == ALL ? 1 : PLANES); p++) {
        const double width = fmin(extents[p][1], (double)v->columns) - fmax(extents[p][0], 0);
        const double height = fmin(extents[p][3], (double)v->rows) - fmax(extents[p][2], 0);
        if (width > 0 && height > 0) c.sums += width * height * (of == ALL ? c.accumulators : 1);
    }
    return c;
}
