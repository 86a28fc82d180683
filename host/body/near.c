/* Nearest points on triangles. */
#include "body/body.h"

#include "scene/vector.h"

/* Weights of the point of triangle abc nearest to p: regions of the plane by the signs of areas (Ericson,
 * Real-Time Collision Detection (2005) 5.1.5). */
static void nearest_weights(const double *a, const double *b, const double *c, const double *p, double w[3]) {
    double ab[3], ac[3], ap[3], bp[3], cp[3];
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_add_scaled(p, -1, a, ap);
    skg_add_scaled(p, -1, b, bp);
    skg_add_scaled(p, -1, c, cp);
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

double skg_nearest(const skg_body_organ *organ, const double p[3], double reach, skg_link *link) {
    double least = reach * reach, away = 0;
    int found = 0;
    for (int k = 0; k < 3; k++) { /* the whole organ out of reach: most are */
        const double *bounds = organ->mesh->health.bounds;
        double d = fmax(0, fmax(bounds[k] - p[k], p[k] - bounds[3 + k]));
        away += d * d;
    }
    if (away > least) return HUGE_VAL;
    for (int64_t t = 0; t < organ->triangles; t++) {
        const int32_t *corner = organ->corner + 3 * t;
        const double *a = organ->rest + 3 * corner[0], *b = organ->rest + 3 * corner[1];
        const double *c = organ->rest + 3 * corner[2];
        double bound = sqrt(least);
        int apart = 0;
        for (int k = 0; k < 3; k++)
            apart |=
                fmin(a[k], fmin(b[k], c[k])) > p[k] + bound || fmax(a[k], fmax(b[k], c[k])) < p[k] - bound;
        if (apart) continue;
        double w[3], d[3];
        nearest_weights(a, b, c, p, w);
        for (int k = 0; k < 3; k++) d[k] = w[0] * a[k] + w[1] * b[k] + w[2] * c[k] - p[k];
        double square = skg_dot(d, d);
        if (square > least || (found && square == least)) continue;
        found = 1, least = square;
        for (int k = 0; k < 3; k++) link->corner[k] = corner[k], link->weight[k] = w[k];
    }
    return found ? sqrt(least) : HUGE_VAL;
}
