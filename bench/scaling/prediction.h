/* How frames scale with workers: what a frame is made of, what it costs, and what other machines would need.
 * docs/scaling.md explains the model. Times in ns, except where a name says ms; rates in bytes per ns, that is, GB/s. */
#ifndef PREDICTION_H
#define PREDICTION_H

#include "common/scenes.h"

/* A card draws a triangle with one work-item of SCALING_WARP that go together, unless its box has more pixels than
 * SCALING_LARGE_BOX. */
enum { SCALING_WARP = 32, SCALING_LARGE_BOX = 512 };
/* Lanes of a worker's vectors: those of AVX-512. */
enum { SCALING_LANES = 16 };
enum { SCALING_PROJECT, SCALING_SORT, SCALING_RASTER, SCALING_ATTENUATE, SCALING_STAGES };

typedef struct {
    double top, bottom;  /* of the box, rows */
    double vectors, box; /* vector additions, in all planes; pixels of the box */
} scaling_triangle;

/* Work of a frame. */
typedef struct {
    double vertices, triangles;
    /* pixels that triangles cover, by their area; times the planes that each is added to */
    double hits, adds;
    double vectors;      /* vector additions, in all planes */
    double warps;        /* pixels of all boxes, each counted as the largest of its SCALING_WARP */
    double rectangles;   /* pixels of the rectangles of all parts */
    double pixels, sums; /* sums: accumulators in the extents of all planes */
    double planes, accumulators, nodes;
    int64_t rows, row_bytes,
        image_bytes; /* of the detector; of a row of all accumulators; of all accumulators */
    scaling_triangle *list;
} scaling_counts;

scaling_counts scaling_count(const bench_scene *scene, const skg_plan_report *report);

/* Prices of one worker, ns: for a vertex, for sorting a triangle into bands, for setting one up, for a vector addition, for an exponential,
 * for reading an accumulator; and bytes that it clears in a ns. */
typedef struct {
    double vertex, sort, triangle, addition, exponential, accumulator, clear;
} scaling_prices;

typedef struct {
    double ms[SCALING_STAGES];
    double set_ups; /* triangles that are set up, again in each band that they meet */
    double memory;  /* bytes of accumulators */
    double traffic; /* bytes that are read and written, counted once for each pass */
} scaling_frame;

/* A machine of `workers` such workers. */
typedef struct {
    int workers;
    double bandwidth, cache; /* bytes per ns of the memory; bytes of the largest cache */
} scaling_machine;

/* strategy: SKG_STRATEGY_COPIES or SKG_STRATEGY_TILES */
scaling_frame scaling_predict(const scaling_counts *counts, const scaling_prices *prices, int strategy,
                              const scaling_machine *machine);

/* A card by its published figures, as if each lane did an operation in every clock: the least that a frame can take. */
typedef struct {
    const char *name, *source;
    double lanes, ghz, bandwidth, atomics; /* atomics: additions to memory per clock, an assumption */
} scaling_card;

/* With strategy atomics. */
scaling_frame scaling_predict_card(const scaling_counts *counts, const scaling_card *card);

/* Exponentials of a frame in units of an exponential with one plane. */
double scaling_exponentials(const scaling_counts *counts);

#endif
