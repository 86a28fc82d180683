/* Chain Mail as published, by a queue: the rival of the exact solver. */
#ifndef BENCH_QUEUE_H
#define BENCH_QUEUE_H

#include "chainmail/chainmail.h"

/* Scratch for a graph of so many nodes. */
typedef struct {
    int32_t *waiting; /* ring of nodes + 1 places */
    char *queued, *visited;
} queue;

void queue_make(const skg_chain *chain, queue *q);
void queue_free(queue *q);

/* One driven node goes to target (displacement, mm) and waits in a queue; a node that leaves it clamps each
 * neighbour into the box of their link, and neighbours that moved are queued (Gibson, I3D 1997; Li and
 * Brodlie, Comput. Graph. Forum 22(4) (2003) 717-727: our reading, their code is not public). most: 1: each
 * node is moved once; larger: nodes may move again, with at most so many updates per link. u: axis by axis.
 * Returns the updates. */
int64_t queue_move(const skg_chain *chain, int32_t driver, const double target[3], int64_t most, queue *q,
                   double *u);

#endif
