#include "body/near.h"

#include "core/vector.h"

/* Weights of the point of triangle abc that is nearest to p. The signs of areas say which corner, edge or face it
 * lies on (Ericson, Real-Time Collision Detection (2005) 5.1.5). */
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

skg_status skg_near_prepare(skg_body_organ *o) {
    int64_t blocks = (o->triangles + BLOCK - 1) / BLOCK;
    SKG_TRY(skg_alloc(6 * blocks, sizeof *o->block, o->label, &o->block));
    for (int64_t i = 0; i < 6 * blocks; i++) o->block[i] = i % 6 < 3 ? HUGE_VAL : -HUGE_VAL;
    for (int64_t c = 0; c < 3 * o->triangles; c++)
        for (int k = 0; k < 3; k++) {
            double *bounds = o->block + 6 * (c / (3 * BLOCK)), x = o->rest[3 * (int64_t)o->corner[c] + k];
            bounds[k] = fmin(bounds[k], x), bounds[3 + k] = fmax(bounds[3 + k], x);
        }
    return SKG_OK;
}

/* Square of the distance from a point to a box. */
static double box_distance(const double *bounds, const double p[3]) {
    double away = 0;
    for (int k = 0; k < 3; k++) {
        double d = fmax(0, fmax(bounds[k] - p[k], p[k] - bounds[3 + k]));
        away += d * d;
    }
    return away;
}

static void nearest_of_block(const skg_body_organ *o, int64_t block, const double p[3], double *least,
                             int *found, skg_link *link) {
    int64_t end = (block + 1) * BLOCK < o->triangles ? (block + 1) * BLOCK : o->triangles;
    for (int64_t t = block * BLOCK; t < end; t++) {
        const int32_t *corner = o->corner + 3 * t;
        const double *a = o->rest + 3 * corner[0], *b = o->rest + 3 * corner[1], *c = o->rest + 3 * corner[2];
        double w[3], d[3];
        nearest_weights(a, b, c, p, w);
        for (int k = 0; k < 3; k++) d[k] = w[0] * a[k] + w[1] * b[k] + w[2] * c[k] - p[k];
        double square = skg_dot(d, d);
        if (square > *least || (*found && square == *least)) continue;
        *found = 1, *least = square;
        for (int k = 0; k < 3; k++) link->corner[k] = corner[k], link->weight[k] = w[k];
    }
}

double skg_nearest(const skg_body_organ *organ, const double p[3], double reach, skg_link *link) {
    double least = reach * reach;
    int found = 0;
    if (box_distance(organ->bounds, p) > least) return HUGE_VAL;
    for (int64_t block = 0; block * BLOCK < organ->triangles; block++)
        if (box_distance(organ->block + 6 * block, p) <= least)
            nearest_of_block(organ, block, p, &least, &found, link);
    return found ? sqrt(least) : HUGE_VAL;
}

int32_t skg_find_organ(const skg_body *body, const char *word) {
    for (int64_t o = 0; o < body->organs; o++)
        if (skg_label_begins(body->organ[o].label, word)) return (int32_t)o;
    return -1;
}
