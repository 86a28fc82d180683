/* Building the graph of links. */
#include "chainmail/chainmail.h"

#include "core/maths.h"

#include <inttypes.h>
#include <stdlib.h>

static skg_status check_tissue(const char *name, const skg_tissue *t) {
    if (t->alpha_min >= 0 && t->alpha_min <= 1 && t->alpha_max >= 1 && t->beta >= 0 &&
        isfinite(t->alpha_max) && isfinite(t->beta))
        return SKG_OK;
    return skg_fail(
        SKG_ERR_BREATHING,
        "%s: its tissue has alpha_min %g, alpha_max %g, beta %g; without 0 <= alpha_min <= 1 <= alpha_max and "
        "beta >= 0 it would not keep its shape at rest",
        name, t->alpha_min, t->alpha_max, t->beta);
}

/* Rise (sign 1) or fall (sign -1) of u_B - u_A along an axis for a rest offset d. */
static double slack(const skg_tissue *t, const double d[3], int axis, double sign) {
    double along = sign * d[axis];
    double across = fabs(d[(axis + 1) % 3]) + fabs(d[(axis + 2) % 3]);
    return (along > 0 ? (t->alpha_max - 1) * along : (1 - t->alpha_min) * -along) + t->beta * across;
}

static void fill_edges(skg_chain *chain, const double *rest, int64_t links, const int32_t *ends,
                       const skg_tissue *tissues, const int32_t *kind) {
    for (int64_t l = 0; l < links; l++) {
        const skg_tissue *t = tissues + (kind ? kind[l] : 0);
        int32_t a = ends[2 * l], b = ends[2 * l + 1];
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = rest[3 * b + k] - rest[3 * a + k];
        int64_t ab = chain->first[a]++, ba = chain->first[b]++;
        for (int k = 0; k < 3; k++) {
            double rise = slack(t, d, k, 1), fall = slack(t, d, k, -1);
            chain->rise[k][ab] = chain->fall[k][ba] = rise;
            chain->fall[k][ab] = chain->rise[k][ba] = fall;
            chain->slack[k] += 0.5 * (rise + fall) / (double)links;
        }
        chain->node[ab] = b, chain->node[ba] = a;
    }
    for (int64_t i = chain->nodes; i > 0; i--) chain->first[i] = chain->first[i - 1];
    chain->first[0] = 0;
}

static skg_status check_links(const char *name, int64_t nodes, const double *rest, int64_t links,
                              const int32_t *ends, int64_t kinds, const int32_t *kind) {
    for (int64_t i = 0; i < nodes; i++)
        if (!skg_all_finite(rest + 3 * i, 3))
            return skg_fail(SKG_ERR_BREATHING, "%s: node %" PRId64 " is not finite", name, i);
    for (int64_t l = 0; l < links; l++) {
        for (int e = 0; e < 2; e++)
            if (ends[2 * l + e] < 0 || ends[2 * l + e] >= nodes)
                return skg_fail(SKG_ERR_BREATHING,
                                "%s: link %" PRId64 " goes to node %" PRId32 "; nodes are 0 to %" PRId64,
                                name, l, ends[2 * l + e], nodes - 1);
        if (kind && (kind[l] < 0 || kind[l] >= kinds))
            return skg_fail(SKG_ERR_BREATHING,
                            "%s: link %" PRId64 " has tissue %" PRId32 "; tissues are 0 to %" PRId64, name, l,
                            kind[l], kinds - 1);
    }
    return SKG_OK;
}

static skg_status allocate(skg_chain *chain, const char *name, int64_t links) {
    SKG_TRY(skg_copy_text(name ? name : "chain", &chain->name));
    SKG_TRY(skg_alloc(chain->nodes + 1, sizeof(int64_t), chain->name, &chain->first));
    SKG_TRY(skg_alloc(chain->nodes, sizeof(int32_t), chain->name, &chain->driver_of));
    SKG_TRY(skg_alloc(2 * links, sizeof(int32_t), chain->name, &chain->node));
    for (int k = 0; k < 3; k++) {
        SKG_TRY(skg_alloc(2 * links, sizeof(double), chain->name, &chain->rise[k]));
        SKG_TRY(skg_alloc(2 * links, sizeof(double), chain->name, &chain->fall[k]));
        SKG_TRY(skg_chain_make_front(chain->nodes, chain->front + k));
    }
    return SKG_OK;
}

skg_status skg_chain_create(const char *name, int64_t nodes, const double *rest, int64_t links,
                            const int32_t *ends, const skg_tissue *tissues, int64_t kinds,
                            const int32_t *kind, skg_chain **result) {
    *result = NULL;
    if (nodes < 0 || nodes > INT32_MAX - 1 || links < 0)
        return skg_fail(SKG_ERR_BREATHING, "%s: %" PRId64 " nodes and %" PRId64 " links are not possible",
                        name, nodes, links);
    for (int64_t t = 0; t < kinds; t++) SKG_TRY(check_tissue(name, tissues + t));
    SKG_TRY(check_links(name, nodes, rest, links, ends, kinds, kind));

    skg_chain *chain;
    SKG_TRY(skg_alloc(1, sizeof *chain, name, &chain));
    chain->nodes = nodes;
    skg_status status = allocate(chain, name, links);
    if (status != SKG_OK) {
        skg_chain_free(&chain);
        return status;
    }
    for (int64_t e = 0; e < 2 * links; e++)
        if (ends[e] + 1 < nodes) chain->first[ends[e] + 1]++;
    for (int64_t i = 0; i + 1 < nodes; i++) chain->first[i + 1] += chain->first[i];
    fill_edges(chain, rest, links, ends, tissues, kind);
    for (int64_t i = 0; i < nodes; i++) chain->driver_of[i] = -1;
    *result = chain;
    return SKG_OK;
}

void skg_chain_free(skg_chain **address) {
    skg_chain *chain = *address;
    if (!chain) return;
    for (int k = 0; k < 3; k++) {
        skg_chain_free_front(chain->front + k);
        skg_free(&chain->rise[k]);
        skg_free(&chain->fall[k]);
        skg_free(&chain->target[k]);
    }
    skg_free(&chain->node);
    skg_free(&chain->driver);
    skg_free(&chain->driver_of);
    skg_free(&chain->first);
    skg_free(&chain->name);
    skg_free(address);
}

skg_status skg_chain_drive(skg_chain *chain, int64_t drivers, const int32_t *nodes) {
    for (int64_t s = 0; s < drivers; s++)
        if (nodes[s] < 0 || nodes[s] >= chain->nodes)
            return skg_fail(SKG_ERR_BREATHING,
                            "%s: driver %" PRId64 " is node %" PRId32 "; nodes are 0 to %" PRId64,
                            chain->name, s, nodes[s], chain->nodes - 1);
    for (int64_t s = 0; s < chain->drivers; s++) chain->driver_of[chain->driver[s]] = -1;
    chain->drivers = 0;
    SKG_TRY(skg_realloc(drivers, sizeof(int32_t), chain->name, &chain->driver));
    for (int k = 0; k < 3; k++) SKG_TRY(skg_realloc(drivers, sizeof(double), chain->name, &chain->target[k]));
    for (int64_t s = 0; s < drivers; s++) {
        if (chain->driver_of[nodes[s]] >= 0)
            return skg_fail(SKG_ERR_BREATHING,
                            "%s: drivers %" PRId32 " and %" PRId64 " are one node, %" PRId32, chain->name,
                            chain->driver_of[nodes[s]], s, nodes[s]);
        chain->driver_of[nodes[s]] = (int32_t)s;
        chain->driver[s] = nodes[s];
        for (int k = 0; k < 3; k++) chain->target[k][s] = 0;
        chain->drivers = s + 1;
    }
    return SKG_OK;
}

static int compare_links(const void *a, const void *b) {
    const int32_t *p = a, *q = b;
    if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
    return p[1] < q[1] ? -1 : p[1] > q[1];
}

skg_status skg_chain_links(int64_t triangles, const int32_t *corners, const int32_t *node_of, int64_t *links,
                           int32_t **result) {
    *result = NULL;
    int32_t *ends;
    SKG_TRY(skg_alloc(6 * triangles, sizeof(int32_t), "links", &ends));
    int64_t found = 0;
    for (int64_t t = 0; t < triangles; t++)
        for (int c = 0; c < 3; c++) {
            int32_t a = corners[3 * t + c], b = corners[3 * t + (c + 1) % 3];
            if (node_of) a = node_of[a], b = node_of[b];
            if (a == b) continue;
            ends[2 * found] = a < b ? a : b;
            ends[2 * found++ + 1] = a < b ? b : a;
        }
    qsort(ends, (size_t)found, 2 * sizeof(int32_t), compare_links);
    int64_t kept = 0;
    for (int64_t l = 0; l < found; l++) {
        if (kept > 0 && compare_links(ends + 2 * l, ends + 2 * (kept - 1)) == 0) continue;
        ends[2 * kept] = ends[2 * l], ends[2 * kept + 1] = ends[2 * l + 1];
        kept++;
    }
    *links = kept;
    *result = ends;
    return SKG_OK;
}

void skg_chain_check(const skg_chain *chain, const double *u, double tolerance, int64_t *broken,
                     double *worst) {
    *broken = 0, *worst = 0;
    for (int64_t i = 0; i < chain->nodes; i++)
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
            double most = -HUGE_VAL;
            for (int k = 0; k < 3; k++) {
                double stretch = u[k * chain->nodes + chain->node[e]] - u[k * chain->nodes + i];
                most =
                    fmax(most, stretch - chain->rise[k][e]); /* the fall is tested as the neighbour's rise */
            }
            *worst = fmax(*worst, most);
            *broken += most > tolerance;
        }
}

skg_status skg_chain_unreached(const skg_chain *chain, int64_t *count) {
    int32_t *stack, *seen;
    SKG_TRY(skg_alloc(chain->nodes, sizeof(int32_t), chain->name, &stack));
    skg_status status = skg_alloc(chain->nodes, sizeof(int32_t), chain->name, &seen);
    int64_t depth = 0, reached = 0;
    for (int64_t s = 0; status == SKG_OK && s < chain->drivers; s++)
        seen[chain->driver[s]] = 1, stack[depth++] = chain->driver[s];
    while (status == SKG_OK && depth > 0) {
        int32_t i = stack[--depth];
        reached++;
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
            int32_t j = chain->node[e];
            if (!seen[j]) seen[j] = 1, stack[depth++] = j;
        }
    }
    *count = chain->nodes - reached;
    skg_free(&stack);
    skg_free(&seen);
    return status;
}
