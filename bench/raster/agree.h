/* Whether two images of path lengths differ by rounding only. */
#ifndef BENCH_AGREE_H
#define BENCH_AGREE_H

#include <stdint.h>

typedef struct {
    double longest; /* mm: longest path of the reference */
    double rms;     /* mm: of the differences, over the pixels below that are not gross */
    double worst;   /* mm: the largest difference */
    int64_t pixels; /* with a path in either image */
    int64_t gross;  /* pixels that differ by more than a thousandth of the longest path */
} agreement;

void agree(const float *image, const float *reference, int64_t pixels, agreement *out);

/* Whether the rms is at most rms_bar times the longest path, and at most gross_bar pixels are gross. */
int agree_within(const agreement *found, double rms_bar, int64_t gross_bar);

#endif
