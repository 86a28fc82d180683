/* Rays through cells in plain C with OpenMP: what a practised programmer writes first. */
#include "volume/walk.h"

#include <math.h>
#include <stddef.h>

/* Both precisions from one text. */
#define WALK(name, real)                                                                                     \
    static real name(const walk_work *w, const double from[3], const double way[3], double length) {         \
        const ptrdiff_t strides[3] = {1, w->side, (ptrdiff_t)w->side * w->side};                             \
        double enter = 0, leave = 1;                                                                         \
        real next[3], step[3], sum = 0, t;                                                                   \
        ptrdiff_t at = 0, move[3];                                                                           \
        int left[3];                                                                                         \
        for (int k = 0; k < 3; k++) {                                                                        \
            const double a = -from[k] / way[k], b = (w->side - from[k]) / way[k];                            \
            enter = fmax(enter, fmin(a, b)), leave = fmin(leave, fmax(a, b));                                \
        }                                                                                                    \
        if (!(enter < leave)) return 0;                                                                      \
        for (int k = 0; k < 3; k++) {                                                                        \
            const int up = way[k] > 0;                                                                       \
            int cell = (int)floor(from[k] + (enter + 1e-9) * way[k]);                                        \
            cell = cell < 0 ? 0 : cell >= w->side ? w->side - 1 : cell;                                      \
            at += cell * strides[k];                                                                         \
            move[k] = up ? strides[k] : -strides[k];                                                         \
            left[k] = up ? w->side - cell : cell + 1;                                                        \
            next[k] = (real)((cell + up - from[k]) / way[k] - enter);                                        \
            step[k] = (real)fabs(1 / way[k]);                                                                \
        }                                                                                                    \
        for (t = 0;;) {                                                                                      \
            const int k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : next[1] < next[2] ? 1 : 2;       \
            const real weight = (real)w->weights[w->cells[at] - w->low];                                     \
            sum += weight * (next[k] - t);                                                                   \
            t = next[k];                                                                                     \
            if (--left[k] == 0) break;                                                                       \
            next[k] += step[k];                                                                              \
            at += move[k];                                                                                   \
        }                                                                                                    \
        return sum * (real)length;                                                                           \
    }
WALK(walk_float, float)
WALK(walk_double, double)

/* The ray to a pixel in cells, and its length in mm. */
static double ray_of(const walk_work *w, int64_t row, int64_t column, double from[3], double way[3]) {
    const skg_view *v = &w->view;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double i = (double)column - 0.5 * (double)(v->columns - 1),
                     j = (double)row - 0.5 * (double)(v->rows - 1);
        const double to = v->centre[k] + i * v->column_step[k] + j * v->row_step[k];
        from[k] = (v->source[k] / w->size + 0.5) * w->side;
        way[k] = (to - v->source[k]) / w->size * w->side;
        if (way[k] == 0) way[k] = 1e-12;
        square += (to - v->source[k]) * (to - v->source[k]);
    }
    return sqrt(square);
}

void walk_frame(void *user) {
    walk_work *w = user;
#pragma omp parallel for schedule(dynamic, 4)
    for (int64_t r = 0; r < w->view.rows; r++)
        for (int64_t c = 0; c < w->view.columns; c++) {
            double from[3], way[3];
            const double length = ray_of(w, r, c, from, way);
            w->image[r * w->view.columns + c] = walk_float(w, from, way, length);
        }
}

double walk_exactly(const walk_work *w, int64_t row, int64_t column) {
    double from[3], way[3];
    const double length = ray_of(w, row, column, from, way);
    return walk_double(w, from, way, length);
}
