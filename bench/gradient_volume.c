/* The contender of bench_gradient that a volume has: sums of values along rays, and their derivative by six numbers. */
#include "gradient_volume.h"

#include <math.h>
#include <stddef.h>

void volume_fill(volume_work *work) {
    for (int z = 0; z < VOLUME_SIDE; z++)
        for (int y = 0; y < VOLUME_SIDE; y++)
            for (int x = 0; x < VOLUME_SIDE; x++) {
                const double a = 2.0 * x / VOLUME_SIDE - 1, b = 2.0 * y / VOLUME_SIDE - 1,
                             c = 2.0 * z / VOLUME_SIDE - 1;
                const double body = a * a + 2 * b * b + 0.6 * c * c, bones = sin(40 * c) * sin(9 * a);
                work->cells[((size_t)z * VOLUME_SIDE + (size_t)y) * VOLUME_SIDE + (size_t)x] =
                    (float)(body > 0.9                   ? 0
                            : body > 0.75 && bones > 0.6 ? 0.05
                            : body < 0.3                 ? 0.005
                                                         : 0.02);
            }
}

/* The value between cells and its gradient per cell. */
static float value_at(const float *cells, const float at[3], float gradient[3]) {
    enum { ROW = VOLUME_SIDE, SLICE = VOLUME_SIDE * VOLUME_SIDE };
    const float last = VOLUME_SIDE - 1.001f;
    gradient[0] = gradient[1] = gradient[2] = 0;
    if (at[0] < 0 || at[1] < 0 || at[2] < 0 || at[0] > last || at[1] > last || at[2] > last) return 0;
    const int x = (int)at[0], y = (int)at[1], z = (int)at[2];
    const float u = at[0] - (float)x, v = at[1] - (float)y, w = at[2] - (float)z;
    const float *c = cells + (size_t)(z * SLICE + y * ROW + x);
    const float low0 = c[0] + u * (c[1] - c[0]), low1 = c[ROW] + u * (c[ROW + 1] - c[ROW]);
    const float high0 = c[SLICE] + u * (c[SLICE + 1] - c[SLICE]),
                high1 = c[SLICE + ROW] + u * (c[SLICE + ROW + 1] - c[SLICE + ROW]);
    const float low = low0 + v * (low1 - low0), high = high0 + v * (high1 - high0);
    gradient[0] = (1 - w) * ((1 - v) * (c[1] - c[0]) + v * (c[ROW + 1] - c[ROW])) +
                  w * ((1 - v) * (c[SLICE + 1] - c[SLICE]) + v * (c[SLICE + ROW + 1] - c[SLICE + ROW]));
    gradient[1] = (1 - w) * (low1 - low0) + w * (high1 - high0);
    gradient[2] = high - low;
    return low + w * (high - low);
}

/* One ray; its sum is returned. Moving the volume by a twist moves the points against it. */
static double add_ray(const volume_work *work, const double *pixel, double adjoint, double twist[6]) {
    const double *source = work->view.source, cell = work->size / VOLUME_SIDE;
    double way[3], sum = 0, length = 0;
    for (int k = 0; k < 3; k++) way[k] = pixel[k] - source[k], length += way[k] * way[k];
    const double step = sqrt(length) / VOLUME_POINTS, share = -adjoint * step / cell;
    for (int p = 0; p < VOLUME_POINTS; p++) {
        double place[3];
        float at[3], g[3];
        for (int k = 0; k < 3; k++) {
            place[k] = source[k] + (p + 0.5) / VOLUME_POINTS * way[k];
            at[k] = (float)(place[k] / cell + 0.5 * (VOLUME_SIDE - 1));
        }
        sum += (double)value_at(work->cells, at, g);
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            twist[k] += share * (double)g[k];
            twist[3 + k] += share * (place[i] * (double)g[j] - place[j] * (double)g[i]);
        }
    }
    return sum * step;
}

void volume_frame(void *user) {
    volume_work *work = user;
    const skg_view *view = &work->view;
    double t0 = 0, t1 = 0, t2 = 0, t3 = 0, t4 = 0, t5 = 0, shown = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : t0, t1, t2, t3, t4, t5, shown)
    for (int64_t r = 0; r < view->rows; r++) {
        double twist[6] = {0};
        for (int64_t c = 0; c < view->columns; c++) {
            const double i = (double)c - 0.5 * (double)(view->columns - 1),
                         j = (double)r - 0.5 * (double)(view->rows - 1);
            double pixel[3];
            for (int k = 0; k < 3; k++)
                pixel[k] = view->centre[k] + i * view->column_step[k] + j * view->row_step[k];
            shown += add_ray(work, pixel, work->adjoint[r * view->columns + c], twist);
        }
        t0 += twist[0], t1 += twist[1], t2 += twist[2], t3 += twist[3], t4 += twist[4], t5 += twist[5];
    }
    const double twist[6] = {t0, t1, t2, t3, t4, t5 + 0 * shown};
    for (int k = 0; k < 6; k++) work->twist[k] = twist[k];
}
