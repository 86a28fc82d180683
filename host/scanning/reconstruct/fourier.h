/* The filter of a row of pixels. Private. */
#ifndef SKG_FOURIER_H
#define SKG_FOURIER_H

#include "core/core.h"

/* The ramp of Kak and Slaney (Principles of Computerized Tomographic Imaging, 1988, eq. 3.61) between samples one
 * spacing apart, as factors of the discrete Fourier transform. */
typedef struct {
    int64_t length;  /* a power of two, at least twice the number of samples */
    int64_t finer;   /* samples of a filtered row for each of the row */
    int64_t fine;    /* finer * length */
    double *factors; /* [length / 2 + 1] */
    double *cosines; /* [fine / 2] of the transforms, and their sines */
    double *sines;
} skg_row_filter;

/* is_hann: times a Hann window. angle: of a fan of equal angles, rad from one sample to the next, whose ramp is that of Kak and Slaney's
 * eq. 3.97: times (x / sin x)^2 at the angle x; 0: samples lie on a plane. Free also after a failure. */
skg_status skg_row_filter_create(int64_t samples, int is_hann, double angle, skg_row_filter *filter);
void skg_row_filter_free(skg_row_filter *filter);

/* Number of samples of a filtered row. */
static inline int64_t skg_row_fine(const skg_row_filter *filter, int64_t samples) {
    return filter->finer * (samples - 1) + 1;
}

/* Filters samples. work: [2 (fine + length)]; result: [skg_row_fine] */
void skg_row_filter_apply(const skg_row_filter *filter, int64_t samples, const double *row, double *work,
                          float *result);

#endif
