/* The bounds of a mesh and of its components, in one pass over the offsets each time that positions change. */
#include "mesh/mesh.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const float nowhere[6] = {FLT_MAX, FLT_MAX, FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX};

static inline float lower(float a, float b) {
    return a < b ? a : b;
}

static inline float higher(float a, float b) {
    return a > b ? a : b;
}

static void join(float *box, const float *other) {
    for (int k = 0; k < 3; k++) {
        box[k] = lower(other[k], box[k]);
        box[3 + k] = higher(other[3 + k], box[3 + k]);
    }
}

/* Four vertices at a time, whose twelve lanes compilers keep in vectors. Returns 0 if a vertex is not finite, and the box is void. */
static int bound(const float *at, int64_t vertices, float *box) {
    enum { TOGETHER = 4, LANES = 3 * TOGETHER };
    float low[LANES], high[LANES], rest[LANES] = {0};
    int64_t v = 0;
    for (int i = 0; i < LANES; i++) low[i] = FLT_MAX, high[i] = -FLT_MAX;
    for (; v + TOGETHER <= vertices; v += TOGETHER)
        for (int i = 0; i < LANES; i++) {
            const float x = at[3 * v + i];
            low[i] = lower(x, low[i]);
            high[i] = higher(x, high[i]);
            rest[i] += x - x; /* NaN from the first that is not finite on */
        }
    for (int64_t i = 3 * v; i < 3 * vertices; i++) {
        low[i - 3 * v] = lower(at[i], low[i - 3 * v]);
        high[i - 3 * v] = higher(at[i], high[i - 3 * v]);
        rest[i - 3 * v] += at[i] - at[i];
    }
    memcpy(box, nowhere, sizeof nowhere);
    float all = 0;
    for (int i = 0; i < LANES; i++) {
        box[i % 3] = lower(low[i], box[i % 3]);
        box[3 + i % 3] = higher(high[i], box[3 + i % 3]);
        all += rest[i];
    }
    return all == 0;
}

/* Finds the box of the finite vertices alone. Returns the first that is not, or -1. */
static int64_t bound_finite(const float *at, int64_t vertices, float *box) {
    int64_t bad = -1;
    memcpy(box, nowhere, sizeof nowhere);
    for (int64_t v = vertices - 1; v >= 0; v--) {
        const float *p = at + 3 * v;
        if (isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]))
            join(box, (const float[6]){p[0], p[1], p[2], p[0], p[1], p[2]});
        else
            bad = v;
    }
    return bad;
}

void skg_mesh_set_bounds(skg_mesh *mesh) {
    const skg_vertex_run all = {0, mesh->vertices, -1}, *runs = mesh->run_count ? mesh->runs : &all;
    const int64_t count = mesh->run_count ? mesh->run_count : 1;
    float whole[6];
    mesh->first_bad = -1;
    memcpy(whole, nowhere, sizeof whole);
    for (int64_t i = 0; mesh->run_count && i < mesh->pieces; i++)
        memcpy(mesh->boxes + 6 * i, nowhere, sizeof nowhere);
    for (int64_t i = 0; i < count; i++) {
        const float *at = mesh->offsets + 3 * runs[i].first;
        const int64_t vertices = runs[i].end - runs[i].first;
        float box[6];
        if (!bound(at, vertices, box)) {
            const int64_t bad = bound_finite(at, vertices, box);
            if (mesh->first_bad < 0) mesh->first_bad = runs[i].first + bad;
        }
        join(whole, box);
        if (runs[i].piece >= 0) join(mesh->boxes + 6 * (int64_t)runs[i].piece, box);
    }
    memcpy(mesh->lowest, whole, sizeof mesh->lowest);
    memcpy(mesh->highest, whole + 3, sizeof mesh->highest);
}
