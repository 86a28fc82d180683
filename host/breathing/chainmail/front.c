/* One search: from its starts outward over the links, the largest remaining gain first. */
#include "chainmail/chainmail.h"

/* Values of next: the search has not reached the node; or it has, and the node does not wait. */
enum { UNSEEN = -1, QUIET = -2 };

enum { BUCKETS = 512 }; /* enough for motions of 512 times the mean slack; beyond it buckets get wider */

skg_status skg_chain_make_front(int64_t nodes, skg_chain_front *f) {
    SKG_TRY(skg_alloc(nodes, sizeof(double), "chain", &f->gain));
    SKG_TRY(skg_alloc(nodes + BUCKETS, sizeof(int32_t), "chain", &f->next));
    SKG_TRY(skg_alloc(nodes + BUCKETS, sizeof(int32_t), "chain", &f->last));
    SKG_TRY(skg_alloc(nodes, sizeof(int32_t), "chain", &f->seen));
    for (int64_t i = 0; i < nodes; i++) f->next[i] = UNSEEN;
    for (int64_t b = nodes; b < nodes + BUCKETS; b++) f->next[b] = f->last[b] = (int32_t)b;
    return SKG_OK;
}

void skg_chain_free_front(skg_chain_front *f) {
    skg_free(&f->gain);
    skg_free(&f->next);
    skg_free(&f->last);
    skg_free(&f->seen);
}

void skg_chain_start(skg_chain_front *f, int32_t node, double gain) {
    if (f->next[node] == UNSEEN) f->next[node] = QUIET, f->seen[f->found++] = node;
    f->gain[node] = gain;
}

void skg_chain_forget(skg_chain_front *f) {
    for (int64_t n = 0; n < f->found; n++) f->next[f->seen[n]] = UNSEEN, f->gain[f->seen[n]] = 0;
    f->found = 0;
}

static inline void leave(skg_chain_front *f, int32_t node) {
    int32_t next = f->next[node], last = f->last[node];
    f->next[last] = next, f->last[next] = last;
}

/* Puts a node at the end of the bucket of its gain. First in, first out, as in the algorithm of Bellman and Ford,
 * bounds the number of second visits. */
static inline void join(skg_chain_front *f, int64_t nodes, int32_t node) {
    double place = (f->top - f->gain[node]) * f->per_mm;
    int32_t ring = (int32_t)nodes + (place < BUCKETS - 1 ? (int32_t)place : BUCKETS - 1);
    int32_t last = f->last[ring];
    f->next[node] = ring, f->last[node] = last;
    f->next[last] = f->last[ring] = node;
}

static inline void lift(skg_chain_front *f, int64_t nodes, int32_t node, double gain) {
    if (f->next[node] >= 0)
        leave(f, node);
    else if (f->next[node] == UNSEEN)
        f->seen[f->found++] = node;
    f->gain[node] = gain;
    join(f, nodes, node);
}

/* Buckets are as wide as the mean slack, or wider where more than BUCKETS would be needed. Widths from a tenth to
 * three times that made no measurable difference on the thorax. */
static void open_buckets(const skg_chain *chain, int axis, skg_chain_front *f) {
    double low = 0, high = 0;
    for (int64_t n = 0; n < f->found; n++) {
        double gain = f->gain[f->seen[n]];
        low = gain < low ? gain : low, high = gain > high ? gain : high;
    }
    double width = (high - low) / BUCKETS;
    if (width < chain->slack[axis]) width = chain->slack[axis];
    f->top = high, f->per_mm = 1 / width;
    for (int64_t n = 0; n < f->found; n++) join(f, chain->nodes, f->seen[n]);
}

void skg_chain_spread(const skg_chain *chain, int axis, int direction, const double *u, skg_chain_front *f) {
    const double *slack = direction > 0 ? chain->fall[axis] : chain->rise[axis];
    open_buckets(chain, axis, f);
    for (int32_t ring = (int32_t)chain->nodes; ring < chain->nodes + BUCKETS; ring++)
        for (int32_t i = f->next[ring]; i != ring; i = f->next[ring]) {
            leave(f, i);
            f->next[i] = QUIET;
            double gain = f->gain[i], here = u[i];
            for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
                int32_t j = chain->node[e];
                double left = slack[e] + direction * (u[j] - here); /* j follows once the link is taut */
                double offer = gain - (left > 0 ? left : 0);        /* below 0 by rounding only */
                if (offer > f->gain[j]) lift(f, chain->nodes, j, offer);
            }
        }
}
