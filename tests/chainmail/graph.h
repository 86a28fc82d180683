/* Random graphs of links for the tests of Chain Mail, with an oracle that shares nothing with the library. */
#ifndef SKG_TESTS_GRAPH_H
#define SKG_TESTS_GRAPH_H

#include "chainmail/chainmail.h"

#include <stdint.h>

/* Sums of at most 60 terms below 1e3 mm. */
static const double graph_rounding = 60 * 1e3 * 2.3e-16;

enum { GRAPH_NODES = 60, GRAPH_LINKS = 400 };

typedef struct {
    int64_t nodes, links;
    double rest[3 * GRAPH_NODES];
    int32_t ends[2 * GRAPH_LINKS];
    int32_t kind[GRAPH_LINKS];
    skg_tissue tissues[4];
} graph;

/* 0 <= u < 1, the same series everywhere. */
double graph_random(uint64_t *state);

/* A connected graph; the fourth tissue is rigid. */
void graph_make(uint64_t seed, int64_t nodes, int64_t extra_links, graph *g);

skg_chain *graph_chain(const graph *g);

/* All distances of one axis by Floyd and Warshall: distance[i * nodes + j] = most that u_j - u_i can be. */
void graph_distances(const graph *g, int axis, double *distance);

/* Different nodes, each to go up to size mm either way on every axis. */
void graph_drivers(uint64_t *state, int64_t nodes, int64_t count, double size, int32_t *node, double *target);

/* Every link holds to 1e-9 mm. */
void graph_assert_links(const skg_chain *chain, const double *u);

#endif
