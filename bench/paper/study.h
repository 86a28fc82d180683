/* The settings that the parts of the paper's study share, and their CSV file. */
#ifndef BENCH_PAPER_STUDY_H
#define BENCH_PAPER_STUDY_H

#include "common/bench.h"

enum { PAPER_SIZES_MAX = 16 };

typedef struct {
    skg_context *context;
    FILE *csv;               /* may be NULL */
    long series, iterations; /* a point has `series` values, each over `iterations` images */
    long seconds;            /* the time that a point may take: a slow point has fewer images in each value */
    long size;               /* pixels along a side of the detector */
    long triangles[PAPER_SIZES_MAX];
    int sizes;
    long body;   /* triangles of the breathing thorax */
    long pieces; /* points along an edge of the cubic source */
    const char *scene, *reference, *into;
} paper_study;

/* Writes a row of the CSV. at: the number of triangles, or 0; series: the number of the value, or 0. */
void paper_row(const paper_study *study, const char *part, const char *what, int64_t at, long series,
               double value, const char *unit);

#endif
