/* Lines through a volume on the host, in double: for the ranges of path lengths. */
#include "core/maths.h"
#include "scene/volume.h"

#include <math.h>
#include <string.h>

int32_t skg_volume_cell(const skg_volume *v, int64_t at, double *amount) {
    if (v->wide) {
        *amount = v->unit * (double)((const int32_t *)v->cells)[at];
        return 0;
    }
    const uint16_t code = ((const uint16_t *)v->cells)[at];
    *amount = v->amounts[code];
    return v->curve_of[code];
}

/* The inverse of an affine matrix, by cofactors. */
static void invert(const double *m, double *inverse) {
    const double determinant = skg_pose_determinant(m);
    skg_pose_identity(inverse);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int i = (c + 1) % 3, j = (c + 2) % 3, k = (r + 1) % 3, l = (r + 2) % 3;
            inverse[4 * r + c] = (m[4 * i + k] * m[4 * j + l] - m[4 * i + l] * m[4 * j + k]) / determinant;
        }
    for (int r = 0; r < 3; r++)
        inverse[4 * r + 3] =
            -(inverse[4 * r] * m[3] + inverse[4 * r + 1] * m[7] + inverse[4 * r + 2] * m[11]);
}

void skg_volume_to_cells(const skg_volume *volume, const double *pose, double to_cells[16]) {
    double from_cells[16];
    skg_pose_multiply(pose, volume->affine, from_cells);
    invert(from_cells, to_cells);
    for (int r = 0; r < 3; r++) to_cells[4 * r + 3] += 0.5; /* centres lie at halves */
}

/* The share of a line within the box. */
static int clip(const skg_volume *v, const double from[3], const double way[3], double ends[2]) {
    ends[0] = 0, ends[1] = 1;
    for (int k = 0; k < 3; k++) {
        const double size = (double)v->size[k];
        if (way[k] == 0) {
            if (!(from[k] >= 0 && from[k] < size)) return 0;
            continue;
        }
        const double a = -from[k] / way[k], b = (size - from[k]) / way[k];
        ends[0] = fmax(ends[0], fmin(a, b)), ends[1] = fmin(ends[1], fmax(a, b));
    }
    return ends[0] < ends[1];
}

/* From plane to plane: J. Amanatides, A. Woo, A fast voxel traversal algorithm for ray tracing, Eurographics 1987. */
void skg_volume_trace(const skg_volume *v, const double from[3], const double to[3], double *amounts) {
    const int64_t strides[3] = {1, v->size[0], v->size[0] * v->size[1]};
    double way[3], ends[2], next[3], step[3], t;
    int64_t cell[3];
    for (int k = 0; k < 3; k++) way[k] = to[k] - from[k];
    if (!clip(v, from, way, ends)) return;
    t = ends[0];
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * (ends[0] + fmin(ends[1], ends[0] + 1e-9));
        const double at = fmin(fmax(floor(from[k] + middle * way[k]), 0), (double)(v->size[k] - 1));
        cell[k] = (int64_t)at;
        step[k] = way[k] != 0 ? fabs(1 / way[k]) : HUGE_VAL;
        next[k] = way[k] != 0 ? (at + (way[k] > 0) - from[k]) / way[k] : HUGE_VAL;
    }
    while (t < ends[1]) {
        const int k = next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : next[1] <= next[2] ? 1 : 2;
        const double until = fmin(next[k], ends[1]);
        double amount = 0;
        const int32_t curve =
            skg_volume_cell(v, cell[0] * strides[0] + cell[1] * strides[1] + cell[2] * strides[2], &amount);
        if (until > t) amounts[curve] += amount * (until - t), t = until;
        cell[k] += way[k] > 0 ? 1 : -1;
        next[k] += step[k];
        if (cell[k] < 0 || cell[k] >= v->size[k]) return;
    }
}
