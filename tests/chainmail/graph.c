/* Random graphs of links for the tests of Chain Mail, with an oracle that shares nothing with the library. */
#include "chainmail/graph.h"

#include "suite.h"

#include <math.h>

double graph_random(uint64_t *state) { /* xorshift64* */
    *state ^= *state >> 12, *state ^= *state << 25, *state ^= *state >> 27;
    return (double)((*state * 2685821657736338717u) >> 11) * 0x1p-53;
}

void graph_make(uint64_t seed, int64_t nodes, int64_t extra_links, graph *g) {
    uint64_t s = seed * 0x9E3779B97F4A7C15u + 1;
    *g = (graph){.nodes = nodes, .tissues = {{0.7, 1.1, 0.1}, {0.5, 1.5, 0.3}, {0.9, 1.02, 0.01}, {1, 1, 0}}};
    for (int64_t i = 0; i < 3 * nodes; i++) g->rest[i] = 100 * graph_random(&s) - 50;
    for (int64_t l = 0; l < nodes - 1 + extra_links; l++) {
        int32_t a = l < nodes - 1 ? (int32_t)(l + 1) : (int32_t)(graph_random(&s) * (double)nodes);
        int32_t b = (int32_t)(graph_random(&s) * (double)(l < nodes - 1 ? l + 1 : nodes));
        if (a == b) continue;
        g->ends[2 * g->links] = a, g->ends[2 * g->links + 1] = b;
        double draw = graph_random(&s);
        g->kind[g->links++] = draw < 0.05 ? 3 : (int32_t)(draw * 3);
    }
}

skg_chain *graph_chain(const graph *g) {
    skg_chain *chain;
    ck_skg(skg_chain_create("graph", g->nodes, g->rest, g->links, g->ends, g->tissues, 4, g->kind, &chain));
    return chain;
}

void graph_distances(const graph *g, int axis, double *distance) {
    int64_t n = g->nodes;
    for (int64_t i = 0; i < n * n; i++) distance[i] = i / n == i % n ? 0 : HUGE_VAL;
    for (int64_t l = 0; l < g->links; l++)
        for (int way = 0; way < 2; way++) {
            int32_t a = g->ends[2 * l + way], b = g->ends[2 * l + 1 - way];
            const skg_tissue *t = g->tissues + g->kind[l];
            double d[3], across = 0;
            for (int k = 0; k < 3; k++) d[k] = g->rest[3 * b + k] - g->rest[3 * a + k];
            for (int k = 0; k < 3; k++) across += k == axis ? 0 : fabs(d[k]);
            /* upper end of the published box, less the rest offset */
            double high = (d[axis] >= 0 ? t->alpha_max : t->alpha_min) * d[axis] + t->beta * across;
            distance[a * n + b] = fmin(distance[a * n + b], high - d[axis]);
        }
    for (int64_t k = 0; k < n; k++)
        for (int64_t i = 0; i < n; i++)
            for (int64_t j = 0; j < n; j++)
                distance[i * n + j] = fmin(distance[i * n + j], distance[i * n + k] + distance[k * n + j]);
}

void graph_drivers(uint64_t *s, int64_t nodes, int64_t count, double size, int32_t *node, double *target) {
    for (int64_t d = 0; d < count; d++) {
        int twice;
        do {
            twice = 0;
            node[d] = (int32_t)(graph_random(s) * (double)nodes);
            for (int64_t e = 0; e < d; e++) twice |= node[e] == node[d];
        } while (twice);
        for (int k = 0; k < 3; k++) target[3 * d + k] = size * (2 * graph_random(s) - 1);
    }
}

void graph_assert_links(const skg_chain *chain, const double *u) {
    int64_t broken;
    double worst;
    skg_chain_check(chain, u, 1e-9, &broken, &worst);
    ck_assert_msg(broken == 0, "%d links broken, by up to %g mm", (int)broken, worst);
}
