/* Surfaces of volumes by marching tetrahedra, and gyroids.
 *
 * A cell of the grid is cut into six tetrahedra around its diagonal, alike in every cell, so that neighbours agree on their
 * faces. A vertex lies on an edge of the grid and is computed from its lower end, so that all triangles that share it have
 * the same bits. */
#include "core/maths.h"
#include "core/text.h"
#include "mesh/mesh.h"
#include "mesh/pieces.h"

#include <skiagraph/bodies.h>

#include <inttypes.h>
#include <math.h>

/* Corners of a cell are numbered by bits: x, y, z. Every tetrahedron is positively oriented. */
static const int8_t tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                        {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

/* Even permutations that begin with this corner, or with these two. */
static const int8_t one_first[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
static const int8_t two_first[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                       {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

enum { GYROID_CELLS_MAX = 256 };

typedef struct {
    int64_t counts[3]; /* with a layer around the volume that is outside */
    double spacing[3];
    const float *values;
    double level, outside;
    skg_mesh_arrays *arrays; /* NULL: triangles are counted only */
    int64_t triangles;
} marching;

/* The value above the level of a node, at its place in the grid with the layer. */
static double value_at(const marching *m, const int64_t node[3]) {
    int64_t index = 0;
    for (int k = 2; k >= 0; k--) {
        const int64_t inner = node[k] - 1, count = m->counts[k] - 2;
        if (inner < 0 || inner >= count) return m->outside;
        index = index * count + inner;
    }
    return (double)m->values[index] - m->level;
}

typedef struct {
    int64_t node[3], number;
    double value;
} corner;

static void add_point(const marching *m, const corner *a, const corner *b) {
    if (a->number > b->number) {
        const corner *other = a;
        a = b, b = other;
    }
    const double t = a->value / (a->value - b->value);
    double p[3];
    for (int k = 0; k < 3; k++) {
        const double from = (double)a->node[k] - 0.5 * (double)(m->counts[k] - 1);
        p[k] = m->spacing[k] * (from + t * (double)(b->node[k] - a->node[k]));
    }
    skg_add_vertex(m->arrays, p[0], p[1], p[2]);
}

static void add_face(marching *m, const corner *c, const int8_t edges[3][2], int reverse) {
    m->triangles++;
    if (!m->arrays) return;
    const int64_t first = m->arrays->vertices;
    for (int i = 0; i < 3; i++) add_point(m, c + edges[i][0], c + edges[i][1]);
    skg_add_triangle(m->arrays, first, first + (reverse ? 2 : 1), first + (reverse ? 1 : 2));
}

static void march_tetrahedron(marching *m, const corner c[4]) {
    int inside[4], count = 0, lone = 0;
    for (int i = 0; i < 4; i++) count += inside[i] = c[i].value >= 0;
    if (count == 0 || count == 4) return;
    if (count != 2) {
        for (int i = 0; i < 4; i++)
            if (inside[i] == (count == 1)) lone = i;
        const int8_t *p = one_first[lone];
        const int8_t edges[3][2] = {{p[0], p[1]}, {p[0], p[2]}, {p[0], p[3]}};
        add_face(m, c, edges, count == 3);
        return;
    }
    for (int i = 0; i < 6; i++) {
        const int8_t *p = two_first[i];
        if (!(inside[p[0]] && inside[p[1]])) continue;
        const int8_t quad[4][2] = {{p[0], p[2]}, {p[0], p[3]}, {p[1], p[3]}, {p[1], p[2]}};
        const int8_t halves[2][3][2] = {
            {{quad[0][0], quad[0][1]}, {quad[1][0], quad[1][1]}, {quad[2][0], quad[2][1]}},
            {{quad[0][0], quad[0][1]}, {quad[2][0], quad[2][1]}, {quad[3][0], quad[3][1]}}};
        add_face(m, c, halves[0], 0);
        add_face(m, c, halves[1], 0);
    }
}

static void march_cell(marching *m, int64_t x, int64_t y, int64_t z) {
    corner corners[8];
    int inside = 0;
    for (int i = 0; i < 8; i++) {
        corner *c = corners + i;
        c->node[0] = x + (i & 1), c->node[1] = y + (i >> 1 & 1), c->node[2] = z + (i >> 2 & 1);
        c->number = (c->node[2] * m->counts[1] + c->node[1]) * m->counts[0] + c->node[0];
        c->value = value_at(m, c->node);
        inside += c->value >= 0;
    }
    if (inside == 0 || inside == 8) return;
    for (int t = 0; t < 6; t++) {
        corner four[4];
        for (int i = 0; i < 4; i++) four[i] = corners[tetrahedra[t][i]];
        march_tetrahedron(m, four);
    }
}

static void march(marching *m) {
    m->triangles = 0;
    for (int64_t z = 0; z + 1 < m->counts[2]; z++)
        for (int64_t y = 0; y + 1 < m->counts[1]; y++)
            for (int64_t x = 0; x + 1 < m->counts[0]; x++) march_cell(m, x, y, z);
}

/* The greatest value above the level, or an error. */
static skg_status check_values(const int64_t *counts, const float *values, double level, double *greatest) {
    const int64_t all = counts[0] * counts[1] * counts[2];
    *greatest = -1;
    for (int64_t i = 0; i < all; i++) {
        if (!isfinite(values[i]))
            return skg_fail(SKG_ERR_MESH, "isosurface: value %" PRId64 " is not finite", i);
        *greatest = fmax(*greatest, (double)values[i] - level);
    }
    return *greatest >= 0
               ? SKG_OK
               : skg_fail(SKG_ERR_MESH, "isosurface: no value reaches the level %g; give a lower one", level);
}

static skg_status create(const char *shape, const int64_t *counts, const double *spacing, const float *values,
                         double level, skg_mesh **mesh) {
    double greatest = 0;
    skg_mesh_arrays arrays;
    SKG_TRY(check_values(counts, values, level, &greatest));
    marching m = {.values = values, .level = level, .outside = -fmax(greatest, 1e-30)};
    for (int k = 0; k < 3; k++) m.counts[k] = counts[k] + 2, m.spacing[k] = spacing[k];
    march(&m);
    SKG_TRY(skg_pieces_start(shape, 3 * m.triangles, m.triangles, &arrays));
    m.arrays = &arrays;
    march(&m);
    return skg_mesh_adopt(NULL, shape, &arrays, mesh);
}

skg_status skg_mesh_create_isosurface(const int64_t *counts, const double *spacing, const float *values,
                                      double level, skg_mesh **mesh) {
    SKG_PLAIN;
    static const char *const shape = "isosurface";
    SKG_NEEDS(counts);
    SKG_NEEDS(spacing);
    SKG_NEEDS(values);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    for (int k = 0; k < 3; k++) {
        SKG_TRY(skg_check_count(shape, "values along a side", counts[k], 2, 4096));
        SKG_TRY(skg_check_length(shape, "spacing", spacing[k]));
    }
    if (!isfinite(level)) return skg_fail(SKG_ERR_ARGUMENT, "isosurface: the level is not finite");
    return create(shape, counts, spacing, values, level, mesh);
}

/* How far inside the box a point is in cells, and how far inside the sheet, whichever is less. */
static double gyroid(const double *box, double period, double level, double cell, const double p[3]) {
    double angle[3], depth = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        angle[k] = 2 * SKG_PI * p[k] / period;
        depth = fmin(depth, (0.5 * box[k] - fabs(p[k])) / cell);
    }
    const double wave =
        sin(angle[0]) * cos(angle[1]) + sin(angle[1]) * cos(angle[2]) + sin(angle[2]) * cos(angle[0]);
    return fmin(depth, level - fabs(wave));
}

/* The wave changes by at most 2 pi / period sqrt(3) a mm, and an edge of the grid is at most sqrt(3) cells long, so that with so many
 * cells along a period no edge leaps over the sheet, which would leave a hole there. */
static skg_status find_cells(const char *shape, double level, int64_t *cells) {
    if (!(level > 0 && level <= 1.4))
        return skg_fail(SKG_ERR_ARGUMENT, "gyroid: level %g: above 0 to 1.4", level);
    if (3 * SKG_PI / level > GYROID_CELLS_MAX)
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "gyroid: level %g: a sheet so thin would have holes at %d cells along a period; give at least %.2g",
            level, GYROID_CELLS_MAX, 3 * SKG_PI / GYROID_CELLS_MAX + 0.0005);
    const int64_t least = (int64_t)ceil(3 * SKG_PI / level);
    if (*cells == 0) *cells = least < 24 ? 24 : least;
    SKG_TRY(skg_check_count(shape, "cells along a period", *cells, 4, GYROID_CELLS_MAX));
    if (*cells >= least) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "gyroid: with %" PRId64
                    " cells along a period a sheet of level %g may have holes; give at least %" PRId64
                    ", or 0",
                    *cells, level, least);
}

skg_status skg_mesh_create_gyroid(const double *box, double period, double level, int64_t cells,
                                  skg_mesh **mesh) {
    SKG_PLAIN;
    static const char *const shape = "gyroid";
    int64_t counts[3], all = 1, index = 0;
    float *values = NULL;
    SKG_NEEDS(box);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length(shape, "period", period));
    SKG_TRY(find_cells(shape, level, &cells));
    const double cell = period / (double)cells, spacing[3] = {cell, cell, cell};
    for (int k = 0; k < 3; k++) {
        SKG_TRY(skg_check_length(shape, "edge of the box", box[k]));
        if (!(box[k] / cell < 2000))
            return skg_fail(SKG_ERR_ARGUMENT, "gyroid: %g cells along a side are more than 2000",
                            box[k] / cell);
        counts[k] = (int64_t)ceil(box[k] / cell) + 2; /* a node beyond each face */
        all *= counts[k];
    }
    SKG_TRY(skg_alloc(all, sizeof *values, shape, &values));
    for (int64_t z = 0; z < counts[2]; z++)
        for (int64_t y = 0; y < counts[1]; y++)
            for (int64_t x = 0; x < counts[0]; x++) {
                const int64_t node[3] = {x, y, z};
                double p[3];
                for (int k = 0; k < 3; k++) p[k] = cell * ((double)node[k] - 0.5 * (double)(counts[k] - 1));
                values[index++] = (float)gyroid(box, period, level, cell, p);
            }
    const skg_status status = create(shape, counts, spacing, values, 0, mesh);
    skg_free(&values);
    return status;
}
