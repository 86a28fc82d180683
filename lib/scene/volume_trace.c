/* Lines through a volume on the host, in double: for the ranges of path lengths. */
#include "core/maths.h"
#include "scene/volume.h"

#include <math.h>
#include <string.h>

int32_t skg_volume_cell(const skg_volume *v, int64_t at, double *amount) {
    SKG_ASSERT(0 <= at && at < v->size[0] * v->size[1] * v->size[2]);
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
static int clip(const int64_t sizes[3], const double from[3], const double way[3], double ends[2]) {
    ends[0] = 0, ends[1] = 1;
    for (int k = 0; k < 3; k++) {
        const double size = (double)sizes[k];
        if (way[k] == 0) {
            if (!(from[k] >= 0 && from[k] < size)) return 0;
            continue;
        }
        const double a = -from[k] / way[k], b = (size - from[k]) / way[k];
        ends[0] = fmax(ends[0], fmin(a, b)), ends[1] = fmin(ends[1], fmax(a, b));
    }
    return ends[0] < ends[1];
}

/* The two centres that half cell `half` of an axis lies between, and the share of the second at a place in half cells. */
static double between(const skg_volume *v, int axis, int64_t half, double at, int64_t centre[2]) {
    const int64_t lower = (half + 1) / 2 - 1, last = v->size[axis] - 1;
    centre[0] = lower < 0 ? 0 : lower, centre[1] = lower < last ? lower + 1 : last;
    return 0.5 * (at - 1) - (double)lower;
}

/* Adds a value between centres, times a factor. place: in half cells */
static void add_between(const skg_volume *v, const int64_t half[3], const double place[3], double factor,
                        double *amounts) {
    int64_t centre[3][2];
    double share[3];
    for (int k = 0; k < 3; k++) share[k] = between(v, k, half[k], place[k], centre[k]);
    for (int corner = 0; corner < 8; corner++) {
        double own = factor, amount = 0;
        for (int k = 0; k < 3; k++) own *= corner >> k & 1 ? share[k] : 1 - share[k];
        const int64_t at = (centre[2][corner >> 2] * v->size[1] + centre[1][corner >> 1 & 1]) * v->size[0] +
                           centre[0][corner & 1];
        const int32_t curve = skg_volume_cell(v, at, &amount);
        amounts[curve] += own * amount;
    }
}

/* Adds the integral from t to `until` of a line within a cell, or half cell if values are linear: there by Gauss' two points, which
 * are exact for a polynomial of degree 3. */
static void add_piece(const skg_volume *v, const int64_t cell[3], const double from[3], const double way[3],
                      double t, double until, double *amounts) {
    if (!v->linear) {
        double amount = 0;
        const int32_t curve =
            skg_volume_cell(v, (cell[2] * v->size[1] + cell[1]) * v->size[0] + cell[0], &amount);
        amounts[curve] += amount * (until - t);
        return;
    }
    for (int point = 0; point < 2; point++) {
        const double at = 0.5 * (t + until + (point ? 1 : -1) * (until - t) / sqrt(3.0));
        double place[3];
        for (int k = 0; k < 3; k++) place[k] = from[k] + at * way[k];
        add_between(v, cell, place, 0.5 * (until - t), amounts);
    }
}

/* From plane to plane: J. Amanatides, A. Woo, A fast voxel traversal algorithm for ray tracing, Eurographics 1987. */
void skg_volume_trace(const skg_volume *v, const double first[3], const double last[3], double *amounts) {
    const int64_t parts = v->linear ? 2 : 1;
    double from[3], way[3], ends[2], next[3], step[3], t;
    int64_t cell[3], size[3];
    for (int k = 0; k < 3; k++) {
        size[k] = parts * v->size[k];
        from[k] = (double)parts * first[k];
        way[k] = (double)parts * last[k] - from[k];
    }
    if (!clip(size, from, way, ends)) return;
    t = ends[0];
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * (ends[0] + fmin(ends[1], ends[0] + 1e-9));
        const double at = fmin(fmax(floor(from[k] + middle * way[k]), 0), (double)(size[k] - 1));
        cell[k] = (int64_t)at;
        step[k] = way[k] != 0 ? fabs(1 / way[k]) : HUGE_VAL;
        next[k] = way[k] != 0 ? (at + (way[k] > 0) - from[k]) / way[k] : HUGE_VAL;
    }
    while (t < ends[1]) {
        const int k = next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : next[1] <= next[2] ? 1 : 2;
        const double until = fmin(next[k], ends[1]);
        if (until > t) add_piece(v, cell, from, way, t, until, amounts), t = until;
        cell[k] += way[k] > 0 ? 1 : -1;
        next[k] += step[k];
        if (cell[k] < 0 || cell[k] >= size[k]) return;
    }
}
