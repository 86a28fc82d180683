/* The nearest point of a triangle. */
#include "distance/nearest.h"

#include "core/maths.h"

#include <math.h>

/* How far along a side the point nearest to p is, 0 to 1; the square of its distance. */
static double nearest_of_side(const double *from, const double *to, const double *p, double *along) {
    double side[3], away[3];
    skg_add_scaled(to, -1, from, side);
    skg_add_scaled(p, -1, from, away);
    const double square = skg_dot(side, side);
    *along = square > 0 ? fmin(fmax(skg_dot(side, away) / square, 0), 1) : 0;
    skg_add_scaled(away, -*along, side, away);
    return skg_dot(away, away);
}

/* For a triangle so thin that rounding decides on which side of its edges p lies: the nearest point of its sides. */
static void nearest_of_sides(const double *const corner[3], const double *p, double w[3]) {
    double least = HUGE_VAL;
    for (int s = 0; s < 3; s++) {
        double along, square = nearest_of_side(corner[s], corner[(s + 1) % 3], p, &along);
        if (square >= least) continue;
        least = square;
        w[s] = 1 - along, w[(s + 1) % 3] = along, w[(s + 2) % 3] = 0;
    }
}

/* The signs of areas say which corner, edge or face it lies on (Ericson, Real-Time Collision Detection (2005)
 * 5.1.5). */
void skg_triangle_nearest(const double *a, const double *b, const double *c, const double *p, double w[3]) {
    double ab[3], ac[3], ap[3], bp[3], cp[3], normal[3];
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_add_scaled(p, -1, a, ap);
    skg_add_scaled(p, -1, b, bp);
    skg_add_scaled(p, -1, c, cp);
    skg_cross(ab, ac, normal);
    const double side = skg_dot(ab, ab), reach = skg_dot(ac, ac) + skg_dot(ap, ap);
    if (skg_dot(normal, normal) <= 1e-12 * side * reach) { /* 5000 roundings of the products below */
        nearest_of_sides((const double *const[]){a, b, c}, p, w);
        return;
    }
    double d1 = skg_dot(ab, ap), d2 = skg_dot(ac, ap), d3 = skg_dot(ab, bp), d4 = skg_dot(ac, bp);
    double d5 = skg_dot(ab, cp), d6 = skg_dot(ac, cp);
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    w[0] = w[1] = w[2] = 0;
    if (d1 <= 0 && d2 <= 0)
        w[0] = 1;
    else if (d3 >= 0 && d4 <= d3)
        w[1] = 1;
    else if (d6 >= 0 && d5 <= d6)
        w[2] = 1;
    else if (vc <= 0 && d1 >= 0 && d3 <= 0)
        w[1] = d1 / (d1 - d3), w[0] = 1 - w[1];
    else if (vb <= 0 && d2 >= 0 && d6 <= 0)
        w[2] = d2 / (d2 - d6), w[0] = 1 - w[2];
    else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        w[2] = (d4 - d3) / ((d4 - d3) + (d5 - d6)), w[1] = 1 - w[2];
    else
        w[1] = vb / (va + vb + vc), w[2] = vc / (va + vb + vc), w[0] = 1 - w[1] - w[2];
}
