/* The study of Vidal and Villard 2016 (section 4), made again. */
#ifndef BENCH_PAPER_H
#define BENCH_PAPER_H

#include "common/bench.h"

enum { PAPER_MOST_SIZES = 16 };

typedef struct {
    skg_context *context;
    FILE *csv;               /* rows: study, what, triangles, correction, series, value, unit; may be NULL */
    long series, iterations; /* of a point: `series` values, each over so many images */
    long seconds;            /* a point may take; fewer images where more would be needed */
    long size;               /* pixels along a side of the detector */
    long triangles[PAPER_MOST_SIZES];
    int sizes;
    long body;   /* triangles of the breathing thorax */
    long pieces; /* of a cubic source, along an edge */
    const char *scene, *reference, *into;
} paper_study;

/* 4.3.2 and 4.3.3: lengths and intensities of one ray in half, single and double, beside what is printed.
 * Returns 1 where half does not give what is printed for 16 bits. */
int paper_numbers(const paper_study *study);

/* 4.3.4 to 4.3.6: the cube and cylinder of study->scene under three sources, to files study->into... */
void paper_images(const paper_study *study);

/* Fig. 17, 18 and Table 5: images a second against triangles; and of a thorax that breathes. */
void paper_speed(const paper_study *study);

/* A row of the CSV. `at`: triangles, or 0. */
void paper_row(const paper_study *study, const char *part, const char *what, int64_t at, long series,
               double value, const char *unit);

#endif
