/* Struts across thin organs, so that their sides keep their distance. */
#include "body/links.h"

#include "core/maths.h"

#include <string.h>

/* Longest strut in mm: the diaphragm's thickness, 2.5 to 4 mm, and a little more where the faces are not parallel. */
static const double thickest = 4;

/* Vertices in cells as wide as the longest strut, or wider where they are far apart. */
typedef struct {
    double low[3], width;
    int64_t size[3];
    int64_t *first;
    int32_t *list;
    double *normal; /* of the vertices: outward, not of length 1 */
} vertex_grid;

static int64_t cell_at(const vertex_grid *grid, int k, double x) {
    const int64_t at = (int64_t)floor((x - grid->low[k]) / grid->width);
    return at < 0 ? 0 : at >= grid->size[k] ? grid->size[k] - 1 : at;
}

static int64_t cell_of(const vertex_grid *grid, const double p[3]) {
    return (cell_at(grid, 2, p[2]) * grid->size[1] + cell_at(grid, 1, p[1])) * grid->size[0] +
           cell_at(grid, 0, p[0]);
}

/* Sets the number of cells, at most a few for each vertex. Beyond LIMIT of them on an axis, the last holds the rest. */
static int64_t lay_out(const skg_body_organ *o, vertex_grid *grid) {
    enum { MIN_CELLS = 4096, CELLS_OF_VERTEX = 64, LIMIT = 1 << 20 };
    const double wanted = fmax(MIN_CELLS, CELLS_OF_VERTEX * (double)o->vertices);
    double cells;
    grid->width = thickest / 2;
    do {
        grid->width *= 2;
        cells = 1;
        for (int k = 0; k < 3; k++) {
            grid->low[k] = o->bounds[k];
            grid->size[k] = 1 + (int64_t)fmin((o->bounds[3 + k] - o->bounds[k]) / grid->width, LIMIT);
            cells *= (double)grid->size[k];
        }
    } while (cells > wanted && grid->width < 1e300);
    return (int64_t)cells;
}

static skg_status fill_cells(const skg_body_organ *o, vertex_grid *grid) {
    const int64_t cells = lay_out(o, grid);
    SKG_TRY(skg_alloc(cells + 1, sizeof *grid->first, o->label, &grid->first));
    SKG_TRY(skg_alloc(o->vertices, sizeof *grid->list, o->label, &grid->list));
    for (int64_t i = 0; i < o->vertices; i++)
        if (o->node_of[i] == i) grid->first[cell_of(grid, o->rest + 3 * i) + 1]++;
    for (int64_t c = 0; c < cells; c++) grid->first[c + 1] += grid->first[c];
    for (int64_t i = o->vertices - 1; i >= 0;
         i--) /* fills cells from their ends, so that first[c + 1] becomes a start */
        if (o->node_of[i] == i) grid->list[--grid->first[cell_of(grid, o->rest + 3 * i) + 1]] = (int32_t)i;
    memmove(grid->first, grid->first + 1, (size_t)cells * sizeof *grid->first);
    grid->first[cells] = 0;
    for (int64_t i = 0; i < o->vertices; i++) grid->first[cells] += o->node_of[i] == i;
    return SKG_OK;
}

static void add_normals(const skg_body_organ *o, double *normal) {
    for (int64_t t = 0; t < o->triangles; t++) {
        const double *p[3];
        double e[3], f[3], n[3];
        for (int k = 0; k < 3; k++) p[k] = o->rest + 3 * (int64_t)o->corner[3 * t + k];
        skg_add_scaled(p[1], -1, p[0], e);
        skg_add_scaled(p[2], -1, p[0], f);
        skg_cross(e, f, n);
        for (int k = 0; k < 3; k++) {
            double *at = normal + 3 * (int64_t)o->node_of[o->corner[3 * t + k]];
            skg_add_scaled(at, 1, n, at);
        }
    }
}

/* The nearest vertex on the other face, whose normal points the other way. -1: none is near enough. */
static int32_t behind(const skg_body_organ *o, const vertex_grid *grid, int64_t i) {
    const double *p = o->rest + 3 * i;
    double least = thickest * thickest, d[3];
    int32_t best = -1;
    int64_t from[3], to[3];
    for (int k = 0; k < 3; k++)
        from[k] = cell_at(grid, k, p[k] - thickest), to[k] = cell_at(grid, k, p[k] + thickest);
    for (int64_t z = from[2]; z <= to[2]; z++)
        for (int64_t y = from[1]; y <= to[1]; y++)
            for (int64_t x = from[0]; x <= to[0]; x++) {
                const int64_t cell = (z * grid->size[1] + y) * grid->size[0] + x;
                for (int64_t at = grid->first[cell]; at < grid->first[cell + 1]; at++) {
                    const int32_t j = grid->list[at];
                    if (skg_dot(grid->normal + 3 * i, grid->normal + 3 * (int64_t)j) >= 0) continue;
                    skg_add_scaled(o->rest + 3 * (int64_t)j, -1, p, d);
                    const double square = skg_dot(d, d);
                    if (square < least || (square == least && j < best)) least = square, best = j;
                }
            }
    return best;
}

skg_status skg_body_add_struts(const skg_body_organ *o, int64_t *links, int32_t **ends) {
    vertex_grid grid = {0};
    int32_t *other = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(3 * o->vertices, sizeof *grid.normal, o->label, &grid.normal));
    SKG_TRY_CLEANUP(skg_alloc(o->vertices, sizeof *other, o->label, &other));
    SKG_TRY_CLEANUP(fill_cells(o, &grid));
    add_normals(o, grid.normal);
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < o->vertices; i++) other[i] = o->node_of[i] == i ? behind(o, &grid, i) : -1;
    SKG_TRY_CLEANUP(skg_realloc(2 * (*links + o->vertices), sizeof **ends, o->label, ends));
    for (int32_t i = 0; i < o->vertices; i++) { /* two that are each other's nearest have one strut */
        if (other[i] < 0 || (other[i] < i && other[other[i]] == i)) continue;
        (*ends)[2 * *links] = i, (*ends)[2 * (*links)++ + 1] = other[i];
    }
cleanup:
    skg_free(&grid.normal);
    skg_free(&grid.first);
    skg_free(&grid.list);
    skg_free(&other);
    return status;
}
