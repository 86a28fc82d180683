/* How many cosines the smoothing of scatter keeps: up to the order at which noise outweighs what they hold. */
#include "scatter/smoothing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half the order of the first octave that may be empty; standard errors above which an octave is not. */
enum { LEAST = 4 };
static const double SURE = 2;

/* Among the coefficients that are left out, those with more than so many times the median variance count less. */
static const double NOISY = 2;

/* The choice prefers what seems small by chance: the smaller of two normal numbers is 1 / sqrt(pi) below their mean on average. */
static const double CHOSEN = 0.5641895835477563;

static int64_t smaller(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* By order, from 1 to `most`: variance; what the coefficients hold beyond noise; the square of its standard error. */
typedef struct {
    int64_t most;
    double *variance, *signal, *fourth;
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
    double median = 0;
    for (int64_t k = 0; k < size; k++)
        if (orders[k] > p->most) p->most = orders[k];
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->variance, "smoothing", &p->variance));
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->signal, "smoothing", &p->signal));
    SKG_TRY(skg_alloc(p->most + 1, sizeof *p->fourth, "smoothing", &p->fourth));
    SKG_TRY(find_median(size, variance, &median));
    for (int64_t k = 0; k < size; k++) {
        const double own = variance[k], share = own > NOISY * median ? NOISY * median / own : 1;
        const int64_t order = orders[k];
        p->variance[order] += own;
        p->signal[order] += share * (value[k] * value[k] - own);
        p->fourth[order] += 2 * share * share * own * own;
    }
    return SKG_OK;
}

static void drop(profile *p) {
    skg_free(&p->variance);
    skg_free(&p->signal);
    skg_free(&p->fourth);
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

static void choose(const profile *p, skg_choice *choice) {
    const int64_t last = last_order(p);
    double left = 0, fourth = 0, variance = 0, best = HUGE_VAL;
    for (int64_t k = 1; k <= last; k++) variance += p->variance[k];
    for (int64_t k = last; k >= 1; k--) { /* from all of them to one */
        if (variance + left <= best) {
            best = variance + left, choice->order = k;
            choice->doubt = sqrt(fourth);
            choice->bias = (left > 0 ? left : 0) + CHOSEN * choice->doubt;
        }
        variance -= p->variance[k];
        left += p->signal[k], fourth += p->fourth[k];
    }
}

skg_status skg_choose_order(int64_t count, const int64_t *orders, const double *value, const double *variance,
                            skg_choice *choice) {
    profile p = {0};
    *choice = (skg_choice){.order = 1};
    const skg_status status = find_profile(count, orders, value, variance, &p);
    if (status == SKG_OK) choose(&p, choice);
    drop(&p);
    return status;
}
