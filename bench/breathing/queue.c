/* Chain Mail by a queue, as published: the rival of the exact solver. */
#include "breathing/queue.h"

#include "common/bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void queue_make(const skg_chain *chain, queue *q) {
    q->waiting = bench_alloc((size_t)chain->nodes + 1, sizeof *q->waiting);
    q->queued = bench_alloc((size_t)chain->nodes, 1);
    q->visited = bench_alloc((size_t)chain->nodes, 1);
}

void queue_free(queue *q) {
    free(q->waiting);
    free(q->queued);
    free(q->visited);
}

/* Moves node j into the box of its link with i. Returns 1 if it moved by more than rounding. */
static int clamp(const skg_chain *chain, int64_t e, int32_t i, int32_t j, double *u) {
    int moved = 0;
    for (int k = 0; k < 3; k++) {
        double here = u[k * chain->nodes + i], *there = u + k * chain->nodes + j;
        double into = fmin(fmax(*there, here - chain->fall[k][e]), here + chain->rise[k][e]);
        moved |= fabs(into - *there) > 1e-12;
        *there = into;
    }
    return moved;
}

int64_t queue_move(const skg_chain *chain, int32_t driver, const double target[3], int64_t most, queue *q,
                   double *u) {
    int64_t capacity = chain->nodes + 1, head = 0, tail = 0, updates = 0,
            links = chain->first[chain->nodes] / 2;
    memset(q->queued, 0, (size_t)chain->nodes);
    memset(q->visited, 0, (size_t)chain->nodes);
    for (int k = 0; k < 3; k++) u[k * chain->nodes + driver] = target[k];
    q->waiting[tail++] = driver;
    q->visited[driver] = 1;
    while (head != tail && updates < most * links) {
        int32_t i = q->waiting[head];
        head = (head + 1) % capacity;
        q->queued[i] = 0;
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
            int32_t j = chain->node[e];
            if (j == driver || (most == 1 && q->visited[j])) continue;
            if (!clamp(chain, e, i, j, u)) continue;
            updates++;
            q->visited[j] = 1;
            if (q->queued[j]) continue;
            q->queued[j] = 1;
            q->waiting[tail] = j;
            tail = (tail + 1) % capacity;
        }
    }
    return updates;
}
