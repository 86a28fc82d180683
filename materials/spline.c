/* Natural cubic splines. */
#include "spline.h"

/* Fewer points do not determine a curvature. */
enum { FEWEST = 4 };

void skg_spline_natural(int count, const double *x, const double *y, double *second, double *scratch) {
    for (int i = 0; i < count; i++) second[i] = 0;
    if (count < FEWEST) return;
    /* Tridiagonal system h[i-1] d[i-1] + 2 (h[i-1] + h[i]) d[i] + h[i] d[i+1] = 6 (slope[i] - slope[i-1]). */
    scratch[0] = 0;
    for (int i = 1; i < count - 1; i++) {
        double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
        double bend = 6 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before);
        double pivot = 2 * (before + after) - before * scratch[i - 1];
        scratch[i] = after / pivot;
        second[i] = (bend - before * second[i - 1]) / pivot;
    }
    for (int i = count - 2; i > 0; i--) second[i] -= scratch[i] * second[i + 1];
}

void skg_spline_piece(int count, const double *x, const double *y, double *second, double *scratch) {
    enum { CLOSE = 10 }; /* as spline.h says */
    int first = 0, last = count - 1;
    if (count >= FEWEST) {
        if (CLOSE * (x[1] - x[0]) < x[2] - x[1]) first = 1;
        if (CLOSE * (x[last] - x[last - 1]) < x[last - 1] - x[last - 2]) last--;
    }
    second[0] = second[count - 1] = 0;
    skg_spline_natural(last - first + 1, x + first, y + first, second + first, scratch);
}
