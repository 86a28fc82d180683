/* Chain Mail by a queue, as published: the rival of the exact solver. */
#ifndef BENCH_QUEUE_H
#define BENCH_QUEUE_H

#include "chainmail/chainmail.h"

/* Scratch memory for a chain. */
typedef struct {
    int32_t *waiting; /* ring buffer of nodes + 1 entries */
    char *queued, *visited;
} queue;

void queue_make(const skg_chain *chain, queue *q);
void queue_free(queue *q);

/* The driven node is displaced to `target` (mm) and queued. Each node that is taken from the queue clamps its
 * neighbours into the boxes of their links, and neighbours that moved are queued. This is our reading of
 * Gibson, I3D 1997, and of Li and Brodlie, Comput. Graph. Forum 22(4) (2003) 717-727, whose code is not
 * public. most = 1: each node is moved once; larger: nodes may move again, with at most `most` updates per
 * link on average. u: displacements, axis by axis. Returns the number of updates. */
int64_t queue_move(const skg_chain *chain, int32_t driver, const double target[3], int64_t most, queue *q,
                   double *u);

#endif
