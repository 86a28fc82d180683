/* The filter of a row of pixels. Private. */
#ifndef SKG_FOURIER_H
#define SKG_FOURIER_H

#include "core/core.h"

/* The ramp of Kak and Slaney (Principles of Computerized Tomographic Imaging, 1988, eq. 3.61) between samples one
 * spacing apart, as factors of the discrete Fourier transform. */
typedef struct {
    int64_t length; /* a power of two, at least twice the number of samples */
    double *factors;
    double *cosines; /* [length / 2] of the transform, and its sines */
    double *sines;
} skg_row_filter;

/* is_hann: times a Hann window. Free also after a failure. */
skg_status skg_row_filter_create(int64_t samples, int is_hann, skg_row_filter *filter);
void skg_row_filter_free(skg_row_filter *filter);

/* Filters samples in place. work: [2 length] doubles. */
void skg_row_filter_apply(const skg_row_filter *filter, int64_t samples, float *row, double *work);

#endif
