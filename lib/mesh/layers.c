/* How often a mesh may lie over itself at a point: the components whose boxes meet, and the winding numbers along sampled
 * columns. The integer planes of sums are scaled so that as many layers fit. */
#include "mesh/mesh.h"

#include <float.h>
#include <math.h>

/* Cells along each axis. More would separate components better and cost more: 33^3 counts are 140 KiB. */
enum { CELLS = 32, EDGES = CELLS + 1 };

/* Boxes counted per cell of the mesh's bounds: differences at the edges of each box along z, summed at the end. */
typedef struct {
    double low[3], step[3];
    int32_t *counts; /* [EDGES][EDGES][EDGES] */
} cell_grid;

static int64_t cell_of(const cell_grid *grid, int axis, double x) {
    if (!(grid->step[axis] > 0)) return 0;
    double cell = floor((x - grid->low[axis]) / grid->step[axis]);
    return cell < 0 ? 0 : cell > CELLS - 1 ? CELLS - 1 : (int64_t)cell;
}

/* Columns of cells along z are filled as they are; along x and y the differences at the corners are added. */
static void add_box(cell_grid *grid, const float *box) {
    int64_t from[3], to[3];
    for (int k = 0; k < 3; k++) {
        from[k] = cell_of(grid, k, (double)box[k]);
        to[k] = cell_of(grid, k, (double)box[3 + k]) + 1;
    }
    for (int corner = 0; corner < 4; corner++) {
        const int64_t x = corner & 1 ? to[0] : from[0], y = corner & 2 ? to[1] : from[1];
        const int32_t sign = corner == 0 || corner == 3 ? 1 : -1;
        int32_t *column = grid->counts + (x * EDGES + y) * EDGES;
        for (int64_t z = from[2]; z < to[2]; z++) column[z] += sign;
    }
}

/* Sums the differences along x and y, and returns the largest count. Loops have no dependence along z, so that they take vectors. */
static int64_t largest(cell_grid *grid) {
    enum { PLANE = EDGES * EDGES, ROWS = CELLS * EDGES };
    int32_t *counts = grid->counts, most = 1;
    for (int i = PLANE; i < EDGES * PLANE; i++) counts[i] += counts[i - PLANE];
    for (int x = 0; x < CELLS; x++) {
        int32_t *plane = counts + x * PLANE;
        for (int i = EDGES; i < PLANE; i++) plane[i] += plane[i - EDGES];
        for (int i = 0; i < ROWS; i++) most = plane[i] > most ? plane[i] : most;
    }
    return most;
}

static int64_t bits_of(uint64_t set) {
    return __builtin_popcountll(set);
}

/* The largest number of boxes over a cell, for few boxes: it is reached in a cell in which some box begins along each axis. met: a bit for
 * each box over the cell in which a box begins */
enum { FEW_BOXES = 64 };
static int64_t largest_of_few(const cell_grid *grid, int64_t count, const float *boxes) {
    uint64_t met[3][FEW_BOXES] = {{0}};
    int64_t most = 1;
    for (int k = 0; k < 3; k++) {
        int8_t from[FEW_BOXES], to[FEW_BOXES];
        for (int64_t i = 0; i < count; i++) {
            from[i] = (int8_t)cell_of(grid, k, (double)boxes[6 * i + k]);
            to[i] = (int8_t)cell_of(grid, k, (double)boxes[6 * i + 3 + k]);
        }
        for (int64_t i = 0; i < count; i++)
            for (int64_t j = 0; j < count; j++)
                met[k][i] |= (uint64_t)(from[j] <= from[i] && from[i] <= to[j]) << j;
    }
    for (int64_t x = 0; x < count; x++)
        for (int64_t y = 0; y < count; y++) {
            const uint64_t row = met[0][x] & met[1][y];
            if (!(met[0][x] >> y & 1) || bits_of(row) <= most) continue;
            for (int64_t z = 0; z < count; z++) {
                const int64_t here = bits_of(row & met[2][z]);
                most = here > most ? here : most;
            }
        }
    return most;
}

static void stretch(float *box, const float *at) {
    for (int k = 0; k < 3; k++) {
        box[k] = at[k] < box[k] ? at[k] : box[k];
        box[3 + k] = at[k] > box[3 + k] ? at[k] : box[3 + k];
    }
}

/* The bounds of components that share vertices. */
static skg_status bound_shared(const skg_mesh *mesh, float **boxes) {
    SKG_TRY(skg_alloc(mesh->pieces * 6, sizeof **boxes, mesh->name, boxes));
    for (int64_t i = 0; i < mesh->pieces * 6; i++) (*boxes)[i] = i % 6 < 3 ? FLT_MAX : -FLT_MAX;
    for (int64_t c = 0; c < 3 * mesh->triangles; c++)
        stretch(*boxes + 6 * (int64_t)mesh->piece[c / 3], mesh->offsets + 3 * (int64_t)mesh->corners[c]);
    return SKG_OK;
}

/* How many boxes of components meet in a cell: at least as many as components that meet at a point. */
static skg_status count_boxes(const skg_mesh *mesh, int64_t *most) {
    cell_grid grid = {0};
    float *shared = NULL;
    skg_status status = SKG_OK;
    if (mesh->pieces_share) SKG_TRY(bound_shared(mesh, &shared));
    const float *boxes = shared ? shared : mesh->boxes;
    for (int k = 0; k < 3; k++) {
        grid.low[k] = (double)mesh->lowest[k];
        grid.step[k] = ((double)mesh->highest[k] - (double)mesh->lowest[k]) / CELLS;
    }
    if (mesh->pieces <= FEW_BOXES) {
        *most = largest_of_few(&grid, mesh->pieces, boxes);
        goto cleanup;
    }
    SKG_TRY_CLEANUP(skg_alloc((int64_t)EDGES * EDGES * EDGES, sizeof *grid.counts, mesh->name, &grid.counts));
    for (int64_t i = 0; i < mesh->pieces; i++) add_box(&grid, boxes + 6 * i);
    *most = largest(&grid);
cleanup:
    skg_free(&shared);
    skg_free(&grid.counts);
    return status;
}

/* --- The winding number along columns parallel to z, which stand on a square grid over the bounds in x and y. */

enum { SIDE = 32, SIDE_OF_FEW = 16, FEW = 100000 };

typedef struct {
    double depth;
    int32_t column, sign;
} column_hit;

typedef struct {
    const skg_mesh *mesh;
    int32_t side;
    double low[2], inverse[2]; /* of the first column; columns per mm; 0: the mesh has no extent */
    int64_t count, capacity;
    column_hit *hits;
} column_search;

/* Corners sorted by row, in columns and rows; z in mm. Returns the parity of the swaps, 1 or -1. */
static int sort_corners(const column_search *s, const float *const at[3], double corner[3][3]) {
    int parity = 1;
    for (int k = 0; k < 3; k++) {
        const double here[3] = {((double)at[k][0] - s->low[0]) * s->inverse[0],
                                ((double)at[k][1] - s->low[1]) * s->inverse[1], (double)at[k][2]};
        int to = k;
        for (; to > 0 && corner[to - 1][1] > here[1]; to--, parity = -parity)
            for (int i = 0; i < 3; i++) corner[to][i] = corner[to - 1][i];
        for (int i = 0; i < 3; i++) corner[to][i] = here[i];
    }
    return parity;
}

/* Where a row crosses an edge: x and z. Both triangles of an edge find the same place. */
static void cross_edge(const double *a, const double *b, double row, double crossing[2]) {
    const double share = (row - a[1]) / (b[1] - a[1]);
    crossing[0] = a[0] + share * (b[0] - a[0]);
    crossing[1] = a[2] + share * (b[2] - a[2]);
}

/* The hits of the columns of a row. They balance, as those of rays do (kernels/raster/triangle.clh). */
static skg_status add_row(column_search *s, double corner[3][3], int parity, int32_t row) {
    double a[2], b[2];
    cross_edge(corner[0], corner[2], row, a);
    cross_edge(corner[row >= corner[1][1] ? 1 : 0], corner[row >= corner[1][1] ? 2 : 1], row, b);
    const int forward = a[0] < b[0];
    const double *from = forward ? a : b, *to = forward ? b : a;
    int32_t column = (int32_t)ceil(fmax(from[0], 0));
    if (s->count + s->side > s->capacity) {
        s->capacity = 2 * s->capacity + 4 * (int64_t)s->side * s->side;
        SKG_TRY(skg_realloc(s->capacity, sizeof *s->hits, s->mesh->name, &s->hits));
    }
    for (; column < s->side && column < to[0]; column++) {
        const double share = (column - from[0]) / (to[0] - from[0]);
        s->hits[s->count++] = (column_hit){from[1] + share * (to[1] - from[1]), row * s->side + column,
                                           forward ? parity : -parity};
    }
    return SKG_OK;
}

/* The first column or row that is not before a place. */
static uint8_t first_behind(const column_search *s, int axis, float place) {
    const double at = ((double)place - s->low[axis]) * s->inverse[axis];
    const int32_t whole = (int32_t)at;
    return (uint8_t)(at > 0 ? whole + (whole < at) : 0);
}

/* between: [vertices] scratch, the first column and row behind each. Most triangles of a mesh of many have corners between the same
 * columns or rows, and no hit. */
static skg_status find_hits(column_search *s, uint8_t (*between)[2]) {
    const skg_mesh *mesh = s->mesh;
    for (int64_t v = 0; v < mesh->vertices; v++)
        for (int k = 0; k < 2; k++) between[v][k] = first_behind(s, k, mesh->offsets[3 * v + k]);
    for (int64_t t = 0; t < mesh->triangles; t++) {
        const int32_t *corner = mesh->corners + 3 * t;
        const uint8_t *a = between[corner[0]], *b = between[corner[1]], *c = between[corner[2]];
        if ((a[0] == b[0] && a[0] == c[0]) || (a[1] == b[1] && a[1] == c[1])) continue;
        const float *const at[3] = {mesh->offsets + 3 * (int64_t)corner[0],
                                    mesh->offsets + 3 * (int64_t)corner[1],
                                    mesh->offsets + 3 * (int64_t)corner[2]};
        double sorted[3][3];
        const int parity = sort_corners(s, at, sorted);
        const int32_t first = a[1] < b[1] ? a[1] : b[1], end = a[1] > b[1] ? a[1] : b[1];
        for (int32_t row = first < c[1] ? first : c[1]; row < s->side && row < (end > c[1] ? end : c[1]);
             row++)
            SKG_TRY(add_row(s, sorted, parity, row));
    }
    return SKG_OK;
}

/* Where surfaces touch, a column leaves one before it enters the other; between hits at one depth there is nothing. inside: grows by how far
 * the column is inside, and inside more than once. */
static int64_t winding_of(column_hit *hits, int64_t count, double inside[2]) {
    int64_t winding = 0, most = 0;
    for (int64_t i = 1; i < count; i++) {
        const column_hit moving = hits[i];
        int64_t k = i;
        for (; k > 0 && hits[k - 1].depth > moving.depth; k--) hits[k] = hits[k - 1];
        hits[k] = moving;
    }
    for (int64_t i = 0; i + 1 < count; i++) {
        winding += hits[i].sign;
        const int64_t times = winding < 0 ? -winding : winding;
        const double depth = hits[i + 1].depth - hits[i].depth;
        if (depth > 0 && times > most) most = times;
        for (int k = 0; k < 2; k++) inside[k] += times > k ? depth : 0;
    }
    return most;
}

/* The largest magnitude of the winding number along the columns; twice: the share of their way inside that is inside more than once. */
static skg_status find_winding(column_search *s, int64_t *most, double *twice) {
    double inside[2] = {0, 0};
    const int64_t columns = (int64_t)s->side * s->side;
    column_hit *sorted = NULL;
    int64_t *first = NULL;
    uint8_t(*between)[2] = NULL;
    skg_status status = SKG_OK;
    *most = 0;
    SKG_TRY_CLEANUP(skg_alloc(s->mesh->vertices, sizeof *between, s->mesh->name, &between));
    SKG_TRY_CLEANUP(find_hits(s, between));
    SKG_TRY_CLEANUP(skg_alloc(columns + 2, sizeof *first, s->mesh->name, &first));
    SKG_TRY_CLEANUP(skg_alloc(s->count + 1, sizeof *sorted, s->mesh->name, &sorted));
    for (int64_t i = 0; i < s->count; i++) first[s->hits[i].column + 2]++;
    for (int64_t c = 0; c < columns; c++) first[c + 2] += first[c + 1];
    for (int64_t i = 0; i < s->count; i++) sorted[first[s->hits[i].column + 1]++] = s->hits[i];
    for (int64_t c = 0; c < columns; c++) {
        const int64_t times = winding_of(sorted + first[c], first[c + 1] - first[c], inside);
        *most = times > *most ? times : *most;
    }
    *twice = inside[0] > 0 ? inside[1] / inside[0] : 0;
cleanup:
    skg_free(&between);
    skg_free(&first);
    skg_free(&sorted);
    return status;
}

static skg_status sample_winding(const skg_mesh *mesh, int64_t *most, double *twice) {
    column_search s = {.mesh = mesh, .side = mesh->triangles < FEW ? SIDE_OF_FEW : SIDE};
    *most = 0;
    *twice = 0;
    for (int k = 0; k < 2; k++) {
        const double step = ((double)mesh->highest[k] - (double)mesh->lowest[k]) / s.side;
        if (!(step > 0)) return SKG_OK;
        /* Not in the middle of cells, where meshes like to have vertices: an irrational part of a step further. */
        s.low[k] = (double)mesh->lowest[k] + (k ? 0.4142135623730951 : 0.7320508075688772) * step;
        s.inverse[k] = 1 / step;
    }
    const skg_status status = find_winding(&s, most, twice);
    skg_free(&s.hits);
    return status;
}

/* Columns take much longer than moving the vertices of a mesh of one component. What they would have shown is said by the frames that it
 * concerns (kernels/attenuation/planes.clh). */
static int is_due(const skg_mesh *mesh) {
    enum { FIRST = 4, EVERY = 64 };
    return mesh->version <= FIRST || mesh->version % EVERY == 0;
}

skg_status skg_mesh_count_layers(skg_mesh *mesh) {
    int64_t boxes = 1;
    if (mesh->first_bad >= 0) return SKG_OK; /* no frame shows it */
    if (mesh->pieces > 1) SKG_TRY(count_boxes(mesh, &boxes));
    if (is_due(mesh)) SKG_TRY(sample_winding(mesh, &mesh->winding, &mesh->twice_inside));
    mesh->layers = boxes * mesh->multiplicity;
    if (mesh->winding > mesh->layers) mesh->layers = mesh->winding;
    return SKG_OK;
}

/* The component of each vertex. Returns 0 if components share vertices. */
static int number_vertices(const skg_mesh *mesh, const int32_t *of_triangle, int32_t *of_vertex) {
    for (int64_t v = 0; v < mesh->vertices; v++) of_vertex[v] = -1;
    for (int64_t c = 0; c < 3 * mesh->triangles; c++) {
        int32_t *own = &of_vertex[mesh->corners[c]];
        if (*own >= 0 && *own != of_triangle[c / 3]) return 0;
        *own = of_triangle[c / 3];
    }
    return 1;
}

/* Vertices of one component follow each other in most files. */
static skg_status find_runs(skg_mesh *mesh, const int32_t *of_vertex) {
    int64_t count = 1;
    for (int64_t v = 1; v < mesh->vertices; v++) count += of_vertex[v] != of_vertex[v - 1];
    SKG_TRY(skg_alloc(mesh->pieces * 6, sizeof *mesh->boxes, mesh->name, &mesh->boxes));
    SKG_TRY(skg_alloc(count, sizeof *mesh->runs, mesh->name, &mesh->runs));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        if (v == 0 || of_vertex[v] != of_vertex[v - 1])
            mesh->runs[mesh->run_count++] = (skg_vertex_run){v, v, of_vertex[v]};
        mesh->runs[mesh->run_count - 1].end++;
    }
    skg_mesh_set_bounds(mesh);
    return SKG_OK;
}

/* Components are numbered in the order of their root triangles. */
static skg_status number_pieces(skg_mesh *mesh, const int32_t *root) {
    int32_t *of_triangle = NULL, *of_vertex = NULL, count = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *of_triangle, mesh->name, &of_triangle));
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, sizeof *of_vertex, mesh->name, &of_vertex));
    for (int64_t t = 0; t < mesh->triangles; t++)
        of_triangle[t] = root[t] == t ? count++ : of_triangle[root[t]];
    mesh->pieces_share = !number_vertices(mesh, of_triangle, of_vertex);
    if (mesh->pieces_share)
        mesh->piece = of_triangle, of_triangle = NULL;
    else
        status = find_runs(mesh, of_vertex);
cleanup:
    skg_free(&of_triangle);
    skg_free(&of_vertex);
    return status;
}

skg_status skg_mesh_set_pieces(skg_mesh *mesh, const int32_t *root, int32_t multiplicity) {
    mesh->layers = mesh->multiplicity = multiplicity;
    mesh->pieces = 0;
    for (int64_t t = 0; t < mesh->triangles; t++) mesh->pieces += root[t] == t;
    if (mesh->pieces > 1) SKG_TRY(number_pieces(mesh, root));
    return skg_mesh_count_layers(mesh);
}
