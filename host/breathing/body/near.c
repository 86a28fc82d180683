/* The organ surface that is nearest to a point. */
#include "body/links.h"

#include "core/maths.h"
#include "distance/nearest.h"

double skg_nearest(const skg_body_organ *organ, const double p[3], double reach, skg_link *link) {
    int64_t triangle;
    const double square = skg_tree_nearest(&organ->tree, p, reach * reach, &triangle);
    if (triangle < 0) return HUGE_VAL;
    const int32_t *corner = organ->corner + 3 * triangle;
    const double *rest = organ->rest;
    skg_triangle_nearest(rest + 3 * corner[0], rest + 3 * corner[1], rest + 3 * corner[2], p, link->weight);
    for (int k = 0; k < 3; k++) link->corner[k] = corner[k];
    return sqrt(square);
}

int32_t skg_find_organ(const skg_body *body, const char *word) {
    for (int64_t o = 0; o < body->organs; o++)
        if (skg_label_begins(body->organ[o].label, word)) return (int32_t)o;
    return -1;
}
