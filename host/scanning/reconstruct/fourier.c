/* The filter of a row of pixels. */
#include "reconstruct/fourier.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* A transform of n complex numbers in place, by Cooley and Tukey. sign: of the exponent. */
static void transform(const skg_row_filter *f, int64_t n, double *re, double *im, int sign) {
    const int64_t stride = f->fine / n; /* of the tables */
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
            const double c = f->cosines[k * (n / (2 * half)) * stride];
            const double s = sign * f->sines[k * (n / (2 * half)) * stride];
            for (int64_t i = k; i < n; i += 2 * half) {
                const double r = re[i + half] * c - im[i + half] * s, q = re[i + half] * s + im[i + half] * c;
                re[i + half] = re[i] - r, im[i + half] = im[i] - q;
                re[i] += r, im[i] += q;
            }
        }
}

/* Factor of the ramp of a fan for samples at equal angles: (a / sin a)^2, `away` rad from its middle. Rays of a fan are less than half a
 * turn apart, and so are the samples that the ramp joins; beyond that it joins zeros. */
static double of_fan(double away) {
    static const double MOST = 0.9 * SKG_PI;
    const double x = away < MOST ? away : MOST;
    return x > 0 ? x / sin(x) * (x / sin(x)) : 1;
}

skg_status skg_row_filter_create(int64_t samples, int is_hann, double angle, skg_row_filter *f) {
    double *work = NULL;
    /* Linear interpolation between the samples of a smooth row adds errors of its own, beside edges as large as the bar of 1 %.
     * Of the ramp alone it damps the highest frequencies, which would ripple more without it. */
    *f = (skg_row_filter){.length = 2, .finer = is_hann ? 4 : 1};
    while (f->length < 2 * samples) f->length *= 2;
    f->fine = f->finer * f->length;
    const int64_t n = f->length, fine = f->fine;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(n / 2 + 1, sizeof(double), "filter", &f->factors));
    SKG_TRY_CLEANUP(skg_alloc(fine / 2, sizeof(double), "filter", &f->cosines));
    SKG_TRY_CLEANUP(skg_alloc(fine / 2, sizeof(double), "filter", &f->sines));
    SKG_TRY_CLEANUP(skg_alloc(2 * n, sizeof(double), "filter", &work));
    for (int64_t k = 0; k < fine / 2; k++) {
        f->cosines[k] = cos(2 * SKG_PI * (double)k / (double)fine);
        f->sines[k] = sin(2 * SKG_PI * (double)k / (double)fine);
    }
    work[0] = 0.25;
    for (int64_t k = 1; k <= n / 2; k += 2)
        work[k] = work[n - k] = -of_fan((double)k * angle) / (SKG_PI * SKG_PI * (double)k * (double)k);
    transform(f, n, work, work + n, -1);
    for (int64_t k = 0; k <= n / 2; k++) {
        const double frequency = (double)k / (double)(n / 2);
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

/* Between the samples stand those of the band-limited row: frequencies beyond those of the samples are 0. */
void skg_row_filter_apply(const skg_row_filter *filter, int64_t samples, const double *row, double *work,
                          float *result) {
    const int64_t n = filter->length, half = n / 2, all = filter->fine;
    double *re = work, *im = work + all, *narrow = work + 2 * all;
    memset(narrow, 0, (size_t)(2 * n) * sizeof *narrow);
    memcpy(narrow, row, (size_t)samples * sizeof *row);
    transform(filter, n, narrow, narrow + n, -1);
    memset(work, 0, (size_t)(2 * all) * sizeof *work);
    for (int64_t k = 0; k <= half; k++) {
        const double factor = filter->factors[k] * (k == half ? 0.5 : 1);
        re[k] = factor * narrow[k], im[k] = factor * narrow[n + k];
        if (k == 0) continue;
        re[all - k] = factor * narrow[n - k], im[all - k] = factor * narrow[2 * n - k];
    }
    transform(filter, all, re, im, 1);
    for (int64_t i = 0; i < skg_row_fine(filter, samples); i++) result[i] = (float)re[i];
}
