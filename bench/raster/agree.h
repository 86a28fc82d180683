/* Whether two images of path lengths are the same but for rounding. */
#ifndef BENCH_AGREE_H
#define BENCH_AGREE_H

#include <stdint.h>

typedef struct {
    double longest; /* mm: longest path of the reference */
    double rms;     /* mm: of the differences, over pixels that either one meets, gross ones left out */
    double worst;   /* mm: of all */
    int64_t pixels; /* that either one meets */
    int64_t gross;  /* differ by more than a thousandth of the longest path */
} agreement;

void agree(const float *image, const float *reference, int64_t pixels, agreement *out);

/* 1: rms within rms_bar of the longest path, and at most gross_bar pixels grossly different. */
int agree_within(const agreement *found, double rms_bar, int64_t gross_bar);

#endif
