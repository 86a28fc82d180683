/* Natural cubic splines. They are made when the tables are compiled in, and evaluated by the library. */
#ifndef SKG_SPLINE_H
#define SKG_SPLINE_H

/* Second derivatives second[0..count) of the natural cubic spline through (x[i], y[i]), x rising, count >= 1;
 * they are 0 (a straight line between points) below 4 points. scratch: [count]. */
void skg_spline_natural(int count, const double *x, const double *y, double *second, double *scratch);

/* Second derivatives between two absorption edges. If a point is ten times closer to an edge than to its next neighbour, the
 * point of the edge is not part of the spline, and the short interval is a straight line. The tables agree there to
 * 0.5 % only, and a slope taken from the two points would bend the whole piece by up to 20 %. */
void skg_spline_piece(int count, const double *x, const double *y, double *second, double *scratch);

/* The value at t between x0 and x1, y and second derivatives at both ends given. */
static inline double skg_spline_value(double t, double x0, double x1, const double y[2], const double d[2]) {
    double h = x1 - x0, a = (x1 - t) / h, b = (t - x0) / h;
    return a * y[0] + b * y[1] + ((a * a * a - a) * d[0] + (b * b * b - b) * d[1]) * (h * h / 6);
}

#endif
