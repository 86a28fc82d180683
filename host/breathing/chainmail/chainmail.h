/* Chain Mail, solved exactly (docs/breathing.md). Private.
 *
 * Nodes have rest positions r, and links lie between them. A link from A to B with rest offset d keeps each component of
 * x_B - x_A in a range (Li and Brodlie, Comput. Graph. Forum 22(4) (2003) 717-727): along axis k between alpha_min d_k
 * and alpha_max d_k, widened by beta times the sum of the other two |d|. In displacements u = x - r this reads
 * -fall <= u_B - u_A <= rise with rise, fall >= 0. These are difference constraints, one system for each axis. For the
 * displacements X_s of the driven nodes, with D the length of the shortest path, the bounds
 *     U_i = min_s X_s + D(s->i),   L_i = max_s X_s - D(i->s)
 * hold for any state that keeps every link. Clamping a state that keeps every link to [L, U] keeps them all, meets the
 * drivers, and moves every node as little as possible.
 *
 * Where drivers contradict each other, L > U, and nodes go halfway, to M = (L + U) / 2. The result, u clamped to
 * [min(L, M), max(U, M)], keeps every link too, because means, minima and maxima of states that keep a link keep it.
 *
 * Only nodes that move are visited. Weights are >= 0 and rounding is monotone, so the result is the least rounded path
 * sum in whatever order nodes are visited: the bits are the same for any number of threads and any order of
 * neighbours. */
#ifndef SKG_CHAINMAIL_H
#define SKG_CHAINMAIL_H

#include "core/core.h"

/* How far links may be squeezed (alpha_min, 0 to 1), stretched (alpha_max, >= 1) and sheared (beta, >= 0), as
 * fractions of their rest offset, axis by axis. 1, 1, 0 is rigid; a beta of 0 stiffens sheets along an axis. */
typedef struct {
    double alpha_min, alpha_max, beta;
} skg_tissue;

/* Scratch of one axis: the gains of one search, and the nodes that wait in it, in buckets of descending gain. Any
 * order gives the same gains; this one saves most second visits. */
typedef struct {
    double *gain; /* mm, per node: how far it moves in the direction of the search; 0 where unseen */
    /* per node, then per bucket: the buckets are rings of waiting nodes, each with a place of its own */
    int32_t *next;
    int32_t *last; /* the same rings backwards */
    int32_t *seen; /* nodes whose gain was set */
    int64_t found; /* number of nodes in seen */
    double top;    /* mm: gain of the first bucket */
    double per_mm; /* buckets for each mm of gain */
} skg_chain_front;

typedef struct {
    char *name; /* for messages */
    int64_t nodes, drivers;
    int64_t *first;  /* [nodes + 1] edges of node i are first[i] to first[i + 1] - 1 */
    int32_t *node;   /* per edge: the neighbour */
    double *rise[3]; /* mm per axis and edge: -fall <= u_node - u_here <= rise */
    double *fall[3];
    double slack[3];          /* mm: mean of rise and fall */
    int32_t *driver;          /* node of each driver */
    int32_t *driver_of;       /* per node: its driver, or -1 */
    double *target[3];        /* mm per axis and driver; midpoints where drivers contradict each other */
    skg_chain_front front[3]; /* per axis */
} skg_chain;

typedef struct {
    /* largest L - U: by how much two drivers contradict each other; 0: every driver is met */
    double conflict_mm;
    int32_t axis;       /* of that conflict, 0 to 2; -1: none */
    int64_t driver;     /* the driver of that conflict; -1: none */
    int64_t settled[6]; /* nodes moved, per axis and direction */
} skg_chain_report;

/* Makes a chain of `nodes` nodes (rest: rows of x, y, z in mm) and `links` links. Link l lies between ends[2l] and
 * ends[2l + 1] and has tissues[kind[l]]; kind NULL: tissues[0]. SKG_ERR_BREATHING: a tissue outside
 * 0 <= alpha_min <= 1 <= alpha_max, beta >= 0; a node out of range, or not finite. */
skg_status skg_chain_create(const char *name, int64_t nodes, const double *rest, int64_t links,
                            const int32_t *ends, const skg_tissue *tissues, int64_t kinds,
                            const int32_t *kind, skg_chain **chain);
void skg_chain_free(skg_chain **chain);

/* Sets which nodes are driven, instead of those before; there may be none. SKG_ERR_BREATHING: a node is out of range,
 * or listed twice. */
skg_status skg_chain_drive(skg_chain *chain, int64_t drivers, const int32_t *nodes);

/* Moves drivers to displacement targets (rows of x, y, z, mm), and every other node as little as the links allow. u:
 * in and out, displacements in mm, axis by axis (u[axis * nodes + node]); on input a state that keeps every link
 * (zeros: at rest). Drivers that contradict each other meet halfway; the report says by how much they do, and may be
 * NULL. SKG_ERR_BREATHING: a target is not finite; u is unchanged. */
skg_status skg_chain_move(skg_chain *chain, const double *targets, double *u, skg_chain_report *report);

/* Keeps the links of a wished state. u: in, the wish, rows of x, y, z in mm; out, the wish itself where it keeps every
 * link along an axis, or else the middle of the nearest states above and below that keep them. The report's conflict is
 * twice the largest departure from the wish, as drivers that meet halfway depart. */
skg_status skg_chain_settle(skg_chain *chain, double *u, skg_chain_report *report);

/* Elastic relaxation. In each of the passes, every node goes a fraction (0 to 1) of the way to the mean of its
 * neighbours, then back as far as links and the drivers of the last move ask. Keeps every link. */
skg_status skg_chain_relax(skg_chain *chain, int32_t passes, double fraction, double *u);

/* Number of links that u breaks by more than a tolerance (mm), and the worst excess (mm; <= 0: none is broken). */
void skg_chain_check(const skg_chain *chain, const double *u, double tolerance, int64_t *broken,
                     double *worst);

/* Number of nodes that no driver reaches through links; they never move. */
skg_status skg_chain_unreached(const skg_chain *chain, int64_t *count);

/* The edges of triangles as pairs of nodes, each once. node_of maps corners to nodes (NULL: identity); an edge of a
 * node with itself is left out. The caller frees *ends. */
skg_status skg_chain_links(int64_t triangles, const int32_t *corners, const int32_t *node_of, int64_t *links,
                           int32_t **ends);

/* front.c: gains of one axis in one direction, 1 or -1. */
skg_status skg_chain_make_front(int64_t nodes, skg_chain_front *front);
void skg_chain_free_front(skg_chain_front *front);

/* Starts a search at a node with a gain; called for all starts before the search. */
void skg_chain_start(skg_chain_front *front, int32_t node, double gain);

/* The search: gains over the state u (of that axis) of every node that has to move when the starts do. */
void skg_chain_spread(const skg_chain *chain, int axis, int direction, const double *u,
                      skg_chain_front *front);

/* Resets all gains to 0. */
void skg_chain_forget(skg_chain_front *front);

#endif
