#include "reconstruct/fourier.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* A transform of `length` complex numbers in place, by Cooley and Tukey. work: real parts, then imaginary parts. sign:
 * of the exponent. */
static void transform(const skg_row_filter *f, double *work, int sign) {
    const int64_t n = f->length;
    double *re = work, *im = work + n;
    for (int64_t i = 1, j = 0; i < n; i++) {
        int64_t bit = n >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i >= j) continue;
        const double r = re[i], q = im[i];
        re[i] = re[j], im[i] = im[j], re[j] = r, im[j] = q;
    }
    for (int64_t half = 1; half < n; half *= 2)
        for (int64_t k = 0; k < half; k++) {
            const double c = f->cosines[k * (n / (2 * half))], s = sign * f->sines[k * (n / (2 * half))];
            for (int64_t i = k; i < n; i += 2 * half) {
                const double r = re[i + half] * c - im[i + half] * s, q = re[i + half] * s + im[i + half] * c;
                re[i + half] = re[i] - r, im[i + half] = im[i] - q;
                re[i] += r, im[i] += q;
            }
        }
}

skg_status skg_row_filter_create(int64_t samples, int is_hann, skg_row_filter *f) {
    double *work = NULL;
    *f = (skg_row_filter){.length = 2};
    while (f->length < 2 * samples) f->length *= 2;
    const int64_t n = f->length;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(n, sizeof(double), "filter", &f->factors));
    SKG_TRY_CLEANUP(skg_alloc(n / 2, sizeof(double), "filter", &f->cosines));
    SKG_TRY_CLEANUP(skg_alloc(n / 2, sizeof(double), "filter", &f->sines));
    SKG_TRY_CLEANUP(skg_alloc(2 * n, sizeof(double), "filter", &work));
    for (int64_t k = 0; k < n / 2; k++) {
        f->cosines[k] = cos(2 * SKG_PI * (double)k / (double)n);
        f->sines[k] = sin(2 * SKG_PI * (double)k / (double)n);
    }
    work[0] = 0.25;
    for (int64_t k = 1; k <= n / 2; k += 2)
        work[k] = work[n - k] = -1 / (SKG_PI * SKG_PI * (double)k * (double)k);
    transform(f, work, -1);
    for (int64_t k = 0; k < n; k++) {
        const double frequency = (double)(k <= n / 2 ? k : n - k) / (double)(n / 2);
        f->factors[k] = work[k] / (double)n * (is_hann ? 0.5 * (1 + cos(SKG_PI * frequency)) : 1);
    }
cleanup:
    skg_free(&work);
    return status;
}

void skg_row_filter_free(skg_row_filter *filter) {
    skg_free(&filter->factors);
    skg_free(&filter->cosines);
    skg_free(&filter->sines);
}

void skg_row_filter_apply(const skg_row_filter *filter, int64_t samples, float *row, double *work) {
    memset(work, 0, (size_t)(2 * filter->length) * sizeof *work);
    for (int64_t i = 0; i < samples; i++) work[i] = (double)row[i];
    transform(filter, work, -1);
    for (int64_t k = 0; k < filter->length; k++) {
        work[k] *= filter->factors[k];
        work[filter->length + k] *= filter->factors[k];
    }
    transform(filter, work, 1);
    for (int64_t i = 0; i < samples; i++) row[i] = (float)work[i];
}
