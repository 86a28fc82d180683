/* The open ends of meshes that are not closed. */
#include "geometry/retrace.h"

#include <stdlib.h>

/* A directed edge between welded vertices. */
typedef struct {
    int32_t from, to;
} edge;

static int by_ends(const void *a, const void *b) {
    const edge *x = a, *y = b;
    if (x->from != y->from) return x->from < y->from ? -1 : 1;
    return (x->to > y->to) - (x->to < y->to);
}

/* Orders by the lower end, then by the higher one, so that both directions of an edge are neighbours. */
static int by_pair(const void *a, const void *b) {
    const edge *x = a, *y = b;
    const int32_t x_low = x->from < x->to ? x->from : x->to, y_low = y->from < y->to ? y->from : y->to;
    const int32_t x_high = x->from < x->to ? x->to : x->from, y_high = y->from < y->to ? y->to : y->from;
    if (x_low != y_low) return x_low < y_low ? -1 : 1;
    if (x_high != y_high) return x_high < y_high ? -1 : 1;
    return (x->from > y->from) - (x->from < y->from);
}

static int same_pair(const edge *a, const edge *b) {
    return (a->from == b->from && a->to == b->to) || (a->from == b->to && a->to == b->from);
}

/* Keeps the edges that have no opposite, sorted by their start. Returns their number. */
static int64_t keep_open(edge *edges, int64_t count) {
    int64_t kept = 0;
    qsort(edges, (size_t)count, sizeof *edges, by_pair);
    for (int64_t i = 0, end; i < count; i = end) {
        const edge any = edges[i];
        const edge upward = any.from < any.to ? any : (edge){any.to, any.from};
        const edge downward = {upward.to, upward.from};
        int64_t excess = 0;
        for (end = i; end < count && same_pair(&any, &edges[end]); end++)
            excess += edges[end].from < edges[end].to ? 1 : -1;
        for (int64_t k = 0; k < (excess < 0 ? -excess : excess); k++)
            edges[kept++] = excess > 0 ? upward : downward;
    }
    qsort(edges, (size_t)kept, sizeof *edges, by_ends);
    return kept;
}

static skg_status list_edges(const skg_mesh *mesh, edge **edges, int64_t *count) {
    SKG_TRY(skg_alloc(3 * mesh->triangles, sizeof **edges, "open edges", edges));
    for (int64_t t = 0; t < mesh->triangles; t++)
        for (int k = 0; k < 3; k++) {
            const int32_t a = mesh->corners[3 * t + k], b = mesh->corners[3 * t + (k + 1) % 3];
            const edge e = mesh->weld ? (edge){mesh->weld[a], mesh->weld[b]} : (edge){a, b};
            if (e.from != e.to) (*edges)[(*count)++] = e;
        }
    return SKG_OK;
}

/* The state of tracing loops. At every vertex as many open edges start as end, so that a walk always goes on. */
typedef struct {
    const edge *edges;
    int64_t count;
    int64_t *next;    /* [vertices] the first edge from the vertex that is not used yet */
    int64_t *on_path; /* [vertices] place on the path, counted from 1; 0: not on it */
    int32_t *path;    /* [count + 1] */
} tracing;

static int unused(const tracing *t, int32_t vertex) {
    const int64_t e = t->next[vertex];
    return e < t->count && t->edges[e].from == vertex;
}

/* Walks from a vertex along unused edges. Whenever the path meets itself, the loop is cut off. */
static void trace(tracing *t, int32_t start, skg_caps *caps) {
    int64_t length = 0;
    t->path[length++] = start;
    t->on_path[start] = length;
    while (unused(t, t->path[length - 1])) {
        const int32_t to = t->edges[t->next[t->path[length - 1]]++].to;
        if (!t->on_path[to]) {
            t->path[length++] = to;
            t->on_path[to] = length;
            continue;
        }
        const int64_t from = t->on_path[to] - 1;
        int64_t end = caps->first[caps->loops++];
        for (int64_t k = from; k < length; k++) {
            caps->vertices[end++] = t->path[k];
            t->on_path[t->path[k]] = 0;
        }
        caps->first[caps->loops] = end;
        length = from + 1;
        t->on_path[to] = length;
    }
    t->on_path[t->path[0]] = 0;
}

/* Adds a loop; corners in a row that are the same vertex are one. */
static void add_loop(const int32_t corners[4], skg_caps *caps) {
    int64_t end = caps->first[caps->loops], count = 0;
    for (int k = 0; k < 4; k++)
        if (corners[k] != corners[(k + 1) % 4]) caps->vertices[end + count++] = corners[k];
    if (count < 3) return;
    caps->first[++caps->loops] = end + count;
}

/* Bridges cracks: each open edge moves to the vertices that stand for its ends, and a loop closes the strip in between. Returns how many
 * open edges there are then. Mesh and strips together are closed but for these, whatever stands for what. */
static int64_t bridge(const int32_t *stands_for, edge *edges, int64_t count, skg_caps *caps) {
    int64_t kept = 0;
    for (int64_t e = 0; e < count; e++) {
        const edge old = edges[e], now = {stands_for[old.from], stands_for[old.to]};
        const int32_t strip[4] = {old.from, old.to, now.to, now.from};
        if (now.from != old.from || now.to != old.to) add_loop(strip, caps);
        if (now.from != now.to) edges[kept++] = now;
    }
    return keep_open(edges, kept);
}

static skg_status make_room(const skg_mesh *mesh, int64_t count, tracing *t, skg_caps *caps) {
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *t->next, "open edges", &t->next));
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *t->on_path, "open edges", &t->on_path));
    SKG_TRY(skg_alloc(count + 1, sizeof *t->path, "open edges", &t->path));
    SKG_TRY(skg_alloc(2 * count + 1, sizeof *caps->first, "caps",
                      &caps->first)); /* a strip for each, and loops */
    return skg_alloc(5 * count, sizeof *caps->vertices, "caps", &caps->vertices);
}

skg_status skg_caps_find(const skg_mesh *mesh, skg_caps *caps) {
    tracing t = {0};
    edge *edges = NULL;
    int32_t *stands_for = NULL;
    skg_status status = SKG_OK;
    *caps = (skg_caps){0};
    SKG_TRY_CLEANUP(list_edges(mesh, &edges, &t.count));
    t.edges = edges;
    t.count = keep_open(edges, t.count);
    SKG_TRY_CLEANUP(make_room(mesh, t.count, &t, caps));
    SKG_TRY_CLEANUP(skg_rims_weld(mesh, t.count, &edges->from, &stands_for));
    t.count = bridge(stands_for, edges, t.count, caps);
    for (int64_t v = 0; v < mesh->vertices; v++) t.next[v] = t.count;
    for (int64_t e = t.count; e-- > 0;) t.next[edges[e].from] = e;
    for (int64_t e = 0; e < t.count; e++)
        while (unused(&t, edges[e].from)) trace(&t, edges[e].from, caps);
cleanup:
    skg_free(&edges);
    skg_free(&stands_for);
    skg_free(&t.next);
    skg_free(&t.on_path);
    skg_free(&t.path);
    if (status != SKG_OK) skg_caps_release(caps);
    return status;
}

void skg_caps_release(skg_caps *caps) {
    skg_free(&caps->first);
    skg_free(&caps->vertices);
    caps->loops = 0;
}
