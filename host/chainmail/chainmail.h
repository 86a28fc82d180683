/* Chain Mail, solved exactly. Private.
 *
 * Points with rest positions r and links between them. A link from A to B with rest offset d keeps x_B - x_A,
 * axis by axis, in a box (Li and Brodlie, Comput. Graph. Forum 22(4) (2003) 717-727): along axis k between
 * alpha_min d_k and alpha_max d_k, widened by beta times the sum of the other two |d|. In displacements
 * u = x - r this reads -fall <= u_B - u_A <= rise with rise, fall >= 0: difference constraints, one system
 * per axis. Given the displacements X_s of the driven nodes, the bounds
 *     U_i = min_s X_s + D(s->i),   L_i = max_s X_s - D(i->s)     (D: shortest path)
 * hold for any state that keeps every link, and clamping a state that keeps them to [L, U] keeps them all,
 * meets the drivers, and moves every node as little as possible. Where drivers contradict each other, L > U:
 * there nodes go halfway, to (L + U) / 2. That keeps every link too: the state is u clamped to [min(L, M),
 * max(U, M)] with M = (L + U) / 2, and means, minima and maxima of states that keep a link keep it.
 * Only nodes that move are visited.
 *
 * Weights are >= 0 and rounding is monotone, so the result is the least rounded path sum whatever the order:
 * the same bits for any number of threads and any order of the neighbours. */
#ifndef SKG_CHAINMAIL_H
#define SKG_CHAINMAIL_H

#include "core/core.h"

/* How far links may be squeezed (alpha_min, 0 to 1), stretched (alpha_max, >= 1) and sheared (beta, >= 0), as
 * fractions of their rest offset, axis by axis. 1, 1, 0 is rigid; a beta of 0 stiffens sheets along an axis. */
typedef struct {
    double alpha_min, alpha_max, beta;
} skg_tissue;

/* Scratch of one axis: the gains of one search and the nodes that wait in it, by gain. Any order gives the
 * same gains; descending ones to the width of a bucket spare most second visits. */
typedef struct {
    double *gain;  /* mm, per node: how far it moves in the direction of the search; 0 where unseen */
    int32_t *next; /* rings of waiting nodes, the buckets' own places after those of the nodes */
    int32_t *last; /* the way back */
    int32_t *seen; /* nodes whose gain was set */
    int64_t found; /* in seen */
    double top;    /* mm: gain of the first bucket */
    double per_mm; /* buckets */
} skg_chain_front;

typedef struct {
    char *name; /* for messages */
    int64_t nodes, drivers;
    int64_t *first;  /* nodes + 1: edges of node i are first[i] .. first[i+1]-1 */
    int32_t *node;   /* per edge: the neighbour */
    double *rise[3]; /* mm per axis and edge: -fall <= u_node - u_here <= rise */
    double *fall[3];
    double slack[3];          /* mm: mean of rise and fall */
    int32_t *driver;          /* node of each driver */
    int32_t *driver_of;       /* per node: its driver, or -1 */
    double *target[3];        /* mm per driver, as solved: midpoints where drivers contradict each other */
    skg_chain_front front[3]; /* per axis */
} skg_chain;

typedef struct {
    double conflict_mm; /* by how much two drivers contradict each other; 0: every driver is met exactly */
    int32_t axis;       /* where: 0..2, -1 when there is none */
    int64_t driver;     /* one that is overrun most; -1 */
    int64_t settled[6]; /* nodes moved, per axis and direction */
} skg_chain_report;

/* nodes points (rest: rows of x, y, z in mm), links between ends[2l] and ends[2l+1] with tissues[kind[l]]
 * (kind NULL: tissues[0]). Errors: SKG_ERR_BREATHING (a tissue outside 0 <= alpha_min <= 1 <= alpha_max,
 * beta >= 0; a node out of range; not finite), SKG_ERR_MEMORY. */
skg_status skg_chain_create(const char *name, int64_t nodes, const double *rest, int64_t links,
                            const int32_t *ends, const skg_tissue *tissues, int64_t kinds,
                            const int32_t *kind, skg_chain **chain);
void skg_chain_free(skg_chain **chain);

/* Which nodes are driven, in the place of those before; none is fine. SKG_ERR_BREATHING: out of range, twice
 * the same. */
skg_status skg_chain_drive(skg_chain *chain, int64_t drivers, const int32_t *nodes);

/* Moves drivers to displacement targets (rows of x, y, z, mm) and every other node as little as the links
 * ask. u: displacements in mm, axis by axis (u[axis * nodes + node]); comes as a state that keeps every link
 * (zeros: at rest) and leaves as the new one. Drivers that contradict each other meet halfway, and the report
 * says by how much; report may be NULL. SKG_ERR_BREATHING: a target is not finite; u stays as it was. */
skg_status skg_chain_move(skg_chain *chain, const double *targets, double *u, skg_chain_report *report);

/* Elastic relaxation: `passes` times, every node goes the fraction 0..1 of the way to the mean of its
 * neighbours, then back as far as links and drivers (those of the last move) ask. Keeps every link. */
skg_status skg_chain_relax(skg_chain *chain, int32_t passes, double fraction, double *u);

/* Links that u breaks by more than tolerance (mm), and the worst excess (mm; <= 0: none is broken). */
void skg_chain_check(const skg_chain *chain, const double *u, double tolerance, int64_t *broken,
                     double *worst);

/* Nodes that no driver can reach through links: they stay where they are. */
skg_status skg_chain_unreached(const skg_chain *chain, int64_t *count);

/* Each edge of the triangles once, as pairs of nodes; node_of (NULL: identity) maps corners to nodes, and
 * edges of a node with itself fall out. The caller frees *ends. */
skg_status skg_chain_links(int64_t triangles, const int32_t *corners, const int32_t *node_of, int64_t *links,
                           int32_t **ends);

/* front.c: gains of one axis in one direction, 1 or -1. */
skg_status skg_chain_make_front(int64_t nodes, skg_chain_front *front);
void skg_chain_free_front(skg_chain_front *front);

/* A node gains so much, unless it gains more already. Before the search: all starts of a search. */
void skg_chain_start(skg_chain_front *front, int32_t node, double gain);

/* Gains over the state u (that axis) of every node that has to move when the starts do. */
void skg_chain_spread(const skg_chain *chain, int axis, int direction, const double *u,
                      skg_chain_front *front);

/* No node gains. */
void skg_chain_forget(skg_chain_front *front);

#endif
