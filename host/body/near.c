#include "body/near.h"

#include "core/vector.h"
#include "distance/triangle.h"

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
        skg_triangle_nearest(a, b, c, p, w);
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
