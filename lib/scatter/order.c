/* How much the smoothing of scatter keeps of each cosine: by what a block of orders holds beyond noise. */
#include "scatter/smoothing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half the order of the first octave that may be empty; standard errors above which an octave is not. */
enum { LEAST = 4 };
static const double SURE = 2;

/* Coefficients with more than so many times the median variance count less in what a block holds. */
static const double NOISY = 2;

static int64_t smaller(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* By order, from 1 to `most`: variance; what the coefficients hold beyond noise; the square of its standard error. */
typedef struct {
    int64_t most;
    double *variance, *signal, *fourth, *count;
} profile;

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static skg_status find_median(int64_t count, const double *values, double *median) {
    double *sorted = NULL;
    SKG_TRY(skg_alloc(count, sizeof *sorted, "smoothing", &sorted));
    memcpy(sorted, values, (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, by_size);
    *median = sorted[count / 2];
    skg_free(&sorted);
    return SKG_OK;
}

static skg_status find_profile(int64_t size, const int64_t *orders, const double *value,
                               const double *variance, profile *p) {
    double median = 0, largest = 0;
    for (int64_t k = 0; k < size; k++) {
        if (orders[k] > p->most) p->most = orders[k];
        largest = fmax(largest, fabs(value[k]));
    }
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->variance, "smoothing", &p->variance));
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->signal, "smoothing", &p->signal));
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->fourth, "smoothing", &p->fourth));
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->count, "smoothing", &p->count));
    SKG_TRY(find_median(size, variance, &median));
    median =
        fmax(median, DBL_EPSILON * DBL_EPSILON * largest * largest); /* rounding is no noise of its own */
    for (int64_t k = 0; k < size; k++) {
        const double own = variance[k], share = own > NOISY * median ? NOISY * median / own : 1;
        const int64_t order = orders[k];
        p->variance[order] += share * own;
        p->count[order] += share;
        p->signal[order] += share * (value[k] * value[k] - own);
        p->fourth[order] += 2 * share * share * own * own;
    }
    return SKG_OK;
}

static void drop(profile *p) {
    skg_free(&p->variance);
    skg_free(&p->signal);
    skg_free(&p->fourth);
    skg_free(&p->count);
}

/* Beyond the first octave that holds nothing but noise, nothing is looked for: the noise of all of them together would decide. */
static int64_t last_order(const profile *p) {
    for (int64_t end = LEAST; end < p->most; end *= 2) {
        double signal = 0, fourth = 0;
        for (int64_t k = end + 1; k <= smaller(2 * end, p->most); k++)
            signal += p->signal[k], fourth += p->fourth[k];
        if (signal <= SURE * sqrt(fourth)) return smaller(2 * end, p->most);
    }
    return p->most;
}

/* Orders of a block differ by a fifth at most: wider ones mix what stands out with noise (histories for a thorax to 2 %: .9 of those with
 * halves, .5 of those with a sharp end), narrower ones prefer what seems large by chance (stated errors 15 % too small, one order each). */
static int64_t block_end(int64_t first, int64_t last) {
    return smaller(first + first / 5, last);
}

/* Chooses the share of one block, and adds what is left out of it to the bias. Returns the mean signal of a coefficient, 0: none. */
static double choose_block(const profile *p, int64_t first, int64_t end, skg_choice *choice, double *fourth) {
    double signal = 0, variance = 0, count = 0, doubt = 0;
    for (int64_t k = first; k <= end; k++)
        signal += p->signal[k], variance += p->variance[k], count += p->count[k], doubt += p->fourth[k];
    if (!(signal > 0)) {
        choice->bias += signal, *fourth += doubt;
        return 0;
    }
    const double left = variance / (signal + variance);
    /* The share goes with the noise, which makes the error larger by the second term (Stein's unbiased estimate of the risk). */
    choice->bias += left * left * signal + fmin(4 * left * variance / count, variance);
    *fourth += left * left * left * left * doubt;
    choice->order = end;
    return signal / count;
}

static void choose(const profile *p, const int64_t *orders, const double *variance, int64_t size,
                   double *shares, skg_choice *choice) {
    const int64_t last = last_order(p);
    double fourth = 0;
    for (int64_t k = 0; k < size; k++)
        shares[k] = orders[k] == 1; /* the mean: as many photons as there are */
    for (int64_t first = 2, end; first <= last; first = end + 1) {
        end = block_end(first, last);
        const double signal = choose_block(p, first, end, choice, &fourth);
        for (int64_t k = 0; k < size; k++)
            if (signal > 0 && orders[k] >= first && orders[k] <= end)
                shares[k] = signal / (signal + variance[k]);
    }
    choice->doubt = sqrt(fourth);
    choice->bias = fmax(choice->bias, 0);
}

skg_status skg_choose_order(int64_t count, const int64_t *orders, const double *value, const double *variance,
                            double *shares, skg_choice *choice) {
    profile p = {0};
    *choice = (skg_choice){.order = 1};
    const skg_status status = find_profile(count, orders, value, variance, &p);
    if (status == SKG_OK) choose(&p, orders, variance, count, shares, choice);
    drop(&p);
    return status;
}
