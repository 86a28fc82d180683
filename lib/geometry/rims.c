/* Vertices at the rims of a leaky mesh that stand for each other, because a crack between them is narrow. */
#include "geometry/retrace.h"

#include "core/maths.h"

#include <stdlib.h>

/* How wide a crack may be: a share of the diagonal of the rims' box, and of the mean length of an open edge, so that edges of a fine mesh
 * do not shrink to points. */
static const double OF_BOX = 2e-3, OF_EDGE = 0.25;

/* A narrower one is not looked for, so that cubes of this share of the diagonal have numbers of 32 bits. */
static const double LEAST_OF_BOX = 1e-9;

/* A vertex at a rim, in a grid of cubes whose edge is the width. */
typedef struct {
    int32_t vertex;
    int32_t cube[3];
    double at[3];
} rim_vertex;

typedef struct {
    int64_t count;
    rim_vertex *vertices; /* by cubes, then by number */
    double width;
} rim_grid;

static int by_cube(const void *a, const void *b) {
    const rim_vertex *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->cube[k] != y->cube[k]) return x->cube[k] < y->cube[k] ? -1 : 1;
    return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

/* The first vertex of the grid in a cube or behind it. */
static int64_t first_in(const rim_grid *grid, const int32_t cube[3]) {
    const rim_vertex sought = {.vertex = -1, .cube = {cube[0], cube[1], cube[2]}};
    int64_t first = 0, end = grid->count;
    while (first < end) {
        const int64_t middle = first + (end - first) / 2;
        if (by_cube(&grid->vertices[middle], &sought) < 0)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

/* The nearest vertex within the width that stands for itself; the vertex if there is none. */
static int32_t nearest(const rim_grid *grid, const rim_vertex *own, const int32_t *stands_for) {
    int32_t found = own->vertex;
    double least = grid->width;
    for (int c = 0; c < 27; c++) {
        const int32_t cube[3] = {own->cube[0] + c / 9 - 1, own->cube[1] + c / 3 % 3 - 1,
                                 own->cube[2] + c % 3 - 1};
        for (int64_t k = first_in(grid, cube); k < grid->count; k++) {
            const rim_vertex *other = &grid->vertices[k];
            double way[3];
            if (other->cube[0] != cube[0] || other->cube[1] != cube[1] || other->cube[2] != cube[2]) break;
            if (other->vertex == own->vertex || stands_for[other->vertex] != other->vertex) continue;
            skg_add_scaled(own->at, -1, other->at, way);
            if (skg_length(way) < least) least = skg_length(way), found = other->vertex;
        }
    }
    return found;
}

/* Lists the vertices that edges begin at; at a rim each ends one, too. Sets the width. */
static void list_rims(const skg_mesh *mesh, int64_t count, const int32_t *edges, rim_grid *grid) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, sum = 0;
    for (int64_t e = 0; e < count; e++) {
        rim_vertex *v = &grid->vertices[grid->count];
        double end[3], way[3];
        skg_mesh_vertex(mesh, edges[2 * e], v->at);
        skg_mesh_vertex(mesh, edges[2 * e + 1], end);
        skg_add_scaled(end, -1, v->at, way);
        sum += skg_length(way);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], v->at[k]), high[k] = fmax(high[k], v->at[k]);
        v->vertex = edges[2 * e];
        grid->count += grid->count == 0 || v[-1].vertex != v->vertex; /* edges are sorted by their start */
    }
    skg_add_scaled(high, -1, low, high);
    const double diagonal = skg_length(high);
    grid->width = fmax(fmin(OF_BOX * diagonal, OF_EDGE * sum / (double)count), LEAST_OF_BOX * diagonal);
    for (int64_t i = 0; i < grid->count; i++)
        for (int k = 0; k < 3; k++)
            grid->vertices[i].cube[k] = (int32_t)floor((grid->vertices[i].at[k] - low[k]) / grid->width);
}

skg_status skg_rims_weld(const skg_mesh *mesh, int64_t count, const int32_t *edges, int32_t **stands_for) {
    rim_grid grid = {0};
    SKG_TRY(skg_alloc(mesh->vertices, sizeof **stands_for, "open edges", stands_for));
    for (int64_t v = 0; v < mesh->vertices; v++) (*stands_for)[v] = -1;
    if (count == 0) return SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof *grid.vertices, "open edges", &grid.vertices));
    list_rims(mesh, count, edges, &grid);
    qsort(grid.vertices, (size_t)grid.count, sizeof *grid.vertices, by_cube);
    for (int64_t i = 0; i < grid.count; i++) {
        const rim_vertex *own = &grid.vertices[i];
        (*stands_for)[own->vertex] = nearest(&grid, own, *stands_for);
    }
    skg_free(&grid.vertices);
    return SKG_OK;
}
