/* Curves through points. */
#include "phantom/shapes.h"

#include "core/maths.h"

double skg_shape_curve(const double (*knots)[2], int count, double x) {
    if (x <= knots[0][0]) return knots[0][1];
    if (x >= knots[count - 1][0]) return knots[count - 1][1];
    int k = 0;
    while (x > knots[k + 1][0]) k++;
    int before = k > 0 ? k - 1 : 0, after = k + 2 < count ? k + 2 : count - 1;
    double width = knots[k + 1][0] - knots[k][0], t = (x - knots[k][0]) / width, s = 1 - t;
    double left = (knots[k + 1][1] - knots[before][1]) / (knots[k + 1][0] - knots[before][0]);
    double right = (knots[after][1] - knots[k][1]) / (knots[after][0] - knots[k][0]);
    return knots[k][1] * s * s * (1 + 2 * t) + knots[k + 1][1] * t * t * (3 - 2 * t) +
           width * (left * t * s * s - right * t * t * s);
}

/* Point at t of the curve through four points with centripetal knots: the pyramid of Barry and Goldman (Comput.
 * Graph. 22(4) (1988) 199). */
static void spline_point(const double (*p)[3], const double knot[4], double t, double point[3]) {
    double row[4][3];
    memcpy(row, p, sizeof row);
    for (int level = 1; level < 4; level++)
        for (int i = 0; i + level < 4; i++) {
            /* the last level interpolates between the middle two knots */
            int low = level == 3 ? 1 : i, high = level == 3 ? 2 : i + level;
            double width = knot[high] - knot[low], w = width > 0 ? (t - knot[low]) / width : 0;
            for (int k = 0; k < 3; k++) row[i][k] = (1 - w) * row[i][k] + w * row[i + 1][k];
        }
    memcpy(point, row[0], 3 * sizeof(double));
}

/* Chords of a segment from which arc lengths are taken, and the most points of a curve. */
enum { SPLINE_STEPS = 64, SPLINE_POINTS = 16 };

static void spline_segment(const double (*points)[3], int count, int segment, double t, double point[3]) {
    double p[4][3], knot[4] = {0};
    for (int i = 0; i < 4; i++) {
        int n = segment - 1 + i;
        if (n < 0 || n >= count) { /* beyond an end: its inner neighbour, mirrored */
            int end = n < 0 ? 0 : count - 1, inner = n < 0 ? 1 : count - 2;
            for (int k = 0; k < 3; k++) p[i][k] = 2 * points[end][k] - points[inner][k];
        } else
            memcpy(p[i], points[n], sizeof p[i]);
    }
    for (int i = 1; i < 4; i++) {
        double d[3];
        skg_add_scaled(p[i], -1, p[i - 1], d);
        knot[i] = knot[i - 1] + sqrt(skg_length(d));
    }
    spline_point((const double(*)[3])p, knot, knot[1] + t * (knot[2] - knot[1]), point);
}

skg_status skg_shape_spline(const double (*points)[3], int count, int64_t samples, double (*curve)[3]) {
    if (count < 2 || count > SPLINE_POINTS || samples < 2)
        return skg_fail(SKG_ERR_INTERNAL, "curve through %d points", count);
    double fine[SPLINE_STEPS * SPLINE_POINTS][3], length[SPLINE_STEPS * SPLINE_POINTS] = {0};
    int total = (count - 1) * SPLINE_STEPS;
    for (int i = 0; i <= total; i++) {
        int segment = i < total ? i / SPLINE_STEPS : count - 2;
        spline_segment(points, count, segment, (double)(i - segment * SPLINE_STEPS) / SPLINE_STEPS, fine[i]);
        double d[3];
        if (i > 0) skg_add_scaled(fine[i], -1, fine[i - 1], d);
        if (i > 0) length[i] = length[i - 1] + skg_length(d);
    }
    for (int64_t s = 0, i = 0; s < samples; s++) {
        double at = length[total] * (double)s / (double)(samples - 1);
        while (i + 1 < total && length[i + 1] < at) i++;
        double w = (at - length[i]) / (length[i + 1] - length[i]);
        for (int k = 0; k < 3; k++) curve[s][k] = (1 - w) * fine[i][k] + w * fine[i + 1][k];
    }
    return SKG_OK;
}
