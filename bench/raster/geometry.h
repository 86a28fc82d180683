/* Vectors of a view, in double. */
#ifndef BENCH_GEOMETRY_H
#define BENCH_GEOMETRY_H

static inline void cross(const double *a, const double *b, double *out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Vector from the source to the centre of pixel (row 0, column 0). */
static inline void to_first_pixel(const skg_view *view, double *out) {
    for (int k = 0; k < 3; k++)
        out[k] = view->centre[k] - view->source[k] - (double)(view->columns - 1) / 2 * view->column_step[k] -
                 (double)(view->rows - 1) / 2 * view->row_step[k];
}

#endif
