/* Predicts the stages of a frame from counts and prices. */
#include "scaling/prediction.h"

#include "stage/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BANDS_OF_A_LIST = 8, WORKERS_MAX = 1024 };

/* Operations of a lane, counted in kernels/raster/project.cl, triangle.clh, pixel.clh and attenuate.cl; a division counts as 8. */
static const double VERTEX_OPERATIONS = 45, SET_UP_OPERATIONS = 150, PIXEL_OPERATIONS = 16,
                    ADD_OPERATIONS = 6, NODE_OPERATIONS = 13, READ_OPERATIONS = 10;
static const double LAUNCH = 5e3; /* ns, an assumption */

/* In multiply-adds: each plane takes one. */
double scaling_exponentials(const scaling_counts *counts) {
    return counts->pixels * counts->nodes * (NODE_OPERATIONS + counts->planes) / (NODE_OPERATIONS + 1);
}

/* When the last of several jobs is done, if whoever is free takes the next. busy: [workers], until when. */
static void take(double *busy, int workers, double job) {
    int first = 0;
    for (int w = 1; w < workers; w++)
        if (busy[w] < busy[first]) first = w;
    busy[first] += job;
}

static double last_of(const double *busy, int workers) {
    double last = 0;
    for (int w = 0; w < workers; w++) last = fmax(last, busy[w]);
    return last;
}

/* Each worker clears an image of its own and then claims runs of triangles. */
static double raster_copies(const scaling_counts *c, const scaling_prices *p, int workers) {
    double busy[WORKERS_MAX];
    const int64_t count = (int64_t)c->triangles, claim = skg_raster_claim(count, workers);
    for (int w = 0; w < workers; w++) busy[w] = c->sums * 4 / p->clear;
    for (int64_t from = 0; from < count; from += claim) {
        double job = 0;
        for (int64_t k = from; k < from + claim && k < count; k++)
            job += p->triangle + c->list[k].vectors * p->addition;
        take(busy, workers, job);
    }
    return last_of(busy, workers);
}

/* Each worker claims bands: clears one, draws what meets it, and copies it out. */
static double raster_bands(const scaling_counts *c, const scaling_prices *p, int workers, double *set_ups) {
    double busy[WORKERS_MAX] = {0}, for_all = 0;
    const int64_t high = skg_raster_band_rows(c->rows, c->row_bytes, workers + 1),
                  bands = (c->rows + high - 1) / high;
    double *band = bench_alloc((size_t)bands, sizeof *band);
    for (int64_t k = 0; k < (int64_t)c->triangles; k++) {
        const scaling_triangle *t = &c->list[k];
        if (!(t->bottom > t->top)) continue;
        const int64_t from = (int64_t)t->top / high,
                      to = (int64_t)fmin(ceil(t->bottom) - 1, (double)(c->rows - 1)) / high;
        const int everywhere = to - from >= BANDS_OF_A_LIST;
        for_all += everywhere;
        for (int64_t b = from; b <= to; b++) {
            const double share = fmin(t->bottom, (double)((b + 1) * high)) - fmax(t->top, (double)(b * high));
            band[b] +=
                t->vectors * p->addition * share / (t->bottom - t->top) + (everywhere ? 0 : p->triangle);
            *set_ups += !everywhere;
        }
    }
    *set_ups += for_all * (double)bands;
    for (int64_t b = 0; b < bands; b++)
        take(busy, workers, band[b] + for_all * p->triangle + 2 * c->sums * 4 / p->clear / (double)bands);
    free(band);
    return last_of(busy, workers);
}

scaling_frame scaling_predict(const scaling_counts *c, const scaling_prices *p, int strategy,
                              const scaling_machine *m) {
    const int copies = strategy == SKG_STRATEGY_COPIES;
    const double w = m->workers, images = copies ? w : 1, sums = c->sums * 4;
    scaling_frame f = {.set_ups = 0};
    f.ms[SCALING_PROJECT] = c->vertices * p->vertex / w;
    f.ms[SCALING_SORT] = copies ? 0 : c->triangles * p->sort / w;
    f.ms[SCALING_RASTER] =
        copies ? raster_copies(c, p, m->workers) : raster_bands(c, p, m->workers, &f.set_ups);
    f.ms[SCALING_ATTENUATE] =
        (scaling_exponentials(c) * p->exponential + c->sums * images * p->accumulator) / w;
    if (copies) f.set_ups = c->triangles;
    /* One image more than there are workers is allocated, and not touched unless a worker is late. */
    f.memory = copies ? (w + 1) * (double)c->image_bytes : (double)c->image_bytes;
    const double bytes[SCALING_STAGES] = {28 * c->vertices, copies ? 0 : 16 * c->triangles,
                                          12 * f.set_ups + 16 * c->vertices + images * sums,
                                          images * sums + 4 * c->pixels};
    for (int s = 0; s < SCALING_STAGES; s++) {
        f.traffic += bytes[s];
        if (f.memory > m->cache) f.ms[s] = fmax(f.ms[s], bytes[s] / m->bandwidth);
        f.ms[s] *= 1e-6;
    }
    return f;
}

scaling_frame scaling_predict_card(const scaling_counts *c, const scaling_card *card) {
    const double rate = card->lanes * card->ghz, sums = c->sums * 4;
    const double operations[SCALING_STAGES] = {
        c->vertices * VERTEX_OPERATIONS, 0,
        c->triangles * SET_UP_OPERATIONS + c->warps * PIXEL_OPERATIONS + c->adds * ADD_OPERATIONS,
        c->pixels * c->nodes * (NODE_OPERATIONS + c->planes) + c->sums * READ_OPERATIONS};
    const double bytes[SCALING_STAGES] = {28 * c->vertices, 0,
                                          (double)c->image_bytes + 12 * c->triangles + 16 * c->vertices,
                                          sums + 4 * c->pixels};
    scaling_frame f = {.set_ups = c->triangles, .memory = (double)c->image_bytes};
    for (int s = 0; s < SCALING_STAGES; s++) {
        if (s == SCALING_SORT) continue;
        double ns = fmax(operations[s] / rate, bytes[s] / card->bandwidth);
        if (s == SCALING_RASTER)
            ns = fmax(ns, c->adds / (card->atomics * card->ghz)) + 2 * LAUNCH; /* fills; queue */
        f.ms[s] = (ns + LAUNCH) * 1e-6;
        f.traffic += bytes[s];
    }
    return f;
}
