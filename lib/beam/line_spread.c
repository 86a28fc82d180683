/* Line spread functions of samples one pixel apart. Their transfer function is even about half a cycle a pixel, so that samples are
 * the coefficients of a cosine series of what is wanted up to there (A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal
 * Processing, 3rd ed., 2010, chapter 7). */
#include "beam/line_spread.h"

#include "core/maths.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>

enum { STEPS = SKG_TRANSFER_STEPS };

skg_status skg_frequency_table_check(const char *name, const skg_frequency_table *table, double pixel_mm) {
    const double highest = 0.5 / pixel_mm;
    if (!(pixel_mm > 0 && isfinite(pixel_mm)))
        return skg_fail(SKG_ERR_ARGUMENT, "a pixel of %g mm is not usable; give a size above 0", pixel_mm);
    if (table->count < 2 || !table->per_mm || !table->values)
        return skg_fail(SKG_ERR_ARGUMENT, "a table of the %s has at least two frequencies", name);
    for (int64_t i = 0; i < table->count; i++)
        if (!(isfinite(table->per_mm[i]) &&
              (i ? table->per_mm[i] > table->per_mm[i - 1] : table->per_mm[i] == 0)))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s, row %" PRId64 ": %g per mm; frequencies start with 0 and rise", name, i + 1,
                            table->per_mm[i]);
    /* Frequencies are printed with some digits. */
    if (!(table->per_mm[table->count - 1] >= highest * (1 - 1e-3)))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "the %s ends at %g per mm, but pixels of %g mm show frequencies up to %g per mm; add rows "
            "up to there",
            name, table->per_mm[table->count - 1], pixel_mm, highest);
    return SKG_OK;
}

/* The slope of the table between two rows. */
static double secant(const skg_frequency_table *table, int64_t row) {
    return (table->values[row + 1] - table->values[row]) / (table->per_mm[row + 1] - table->per_mm[row]);
}

/* The slope of the curve at a row: 0 at frequency 0, about which transfer functions are even, that of the last two rows at the
 * end, else that of a monotone cubic. */
static double slope(const skg_frequency_table *table, int64_t row) {
    if (row == 0) return 0;
    if (row == table->count - 1) return secant(table, row - 1);
    return skg_monotone_slope(secant(table, row - 1), secant(table, row));
}

double skg_frequency_table_at(const skg_frequency_table *table, double per_mm) {
    int64_t row = 0;
    while (row < table->count - 2 && per_mm > table->per_mm[row + 1]) row++;
    const double width = table->per_mm[row + 1] - table->per_mm[row];
    const double t = fmin((per_mm - table->per_mm[row]) / width, 1), s = 1 - t;
    return s * s * (1 + 2 * t) * table->values[row] + t * t * (1 + 2 * s) * table->values[row + 1] +
           t * s * width * (s * slope(table, row) - t * slope(table, row + 1));
}

void skg_transfer_of(int64_t count, const double *samples, double *transfer) {
    double sum = 0;
    for (int64_t n = 0; n < count; n++) sum += samples[n];
    for (int k = 0; k <= STEPS; k++) {
        double even = 0, odd = 0;
        for (int64_t n = 0; n < count; n++) {
            const double phase = SKG_PI * k * (double)(n - count / 2) / STEPS;
            even += samples[n] * cos(phase), odd += samples[n] * sin(phase);
        }
        transfer[k] = hypot(even, odd) / sum;
    }
}

/* Sample n, and -n, of the cosine series. */
static double coefficient(const double *transfer, int64_t n) {
    double sum = 0.5 * (transfer[0] + (n % 2 ? -1 : 1) * transfer[STEPS]);
    for (int k = 1; k < STEPS; k++) sum += transfer[k] * cos(SKG_PI * k * (double)n / STEPS);
    return sum / STEPS;
}

skg_status skg_line_spread_fit(const char *name, const double *transfer, double *line, int64_t *samples) {
    enum { HALF = SKG_LINE_SAMPLES_MAX / 2 };
    double series[HALF + 1], reached[STEPS + 1] = {0};
    for (int n = 0; n <= HALF; n++) {
        double error = 0;
        series[n] = coefficient(transfer, n);
        for (int k = 0; k <= STEPS; k++)
            reached[k] += (n ? 2 : 1) * series[n] * cos(SKG_PI * k * (double)n / STEPS);
        if (!(reached[0] > 0)) continue;
        for (int k = 0; k <= STEPS; k++) error = fmax(error, fabs(reached[k] / reached[0] - transfer[k]));
        if (!(error <= SKG_TRANSFER_ERROR)) continue;
        *samples = 2 * (int64_t)n + 1;
        for (int m = -n; m <= n; m++) line[n + m] = series[m < 0 ? -m : m] / reached[0];
        return SKG_OK;
    }
    return skg_fail(
        SKG_ERR_ARGUMENT,
        "the %s changes too fast with the frequency for a blur of %d samples; give a smoother table", name,
        (int)SKG_LINE_SAMPLES_MAX);
}

skg_status skg_line_spread_get(int64_t count, const double *per_mm, const double *mtf, double pixel_mm,
                               double *line, int64_t *samples) {
    SKG_PLAIN;
    const skg_frequency_table table = {count, per_mm, mtf};
    double transfer[STEPS + 1];
    SKG_NEEDS(line);
    SKG_NEEDS(samples);
    *samples = 0;
    SKG_TRY(skg_frequency_table_check("MTF", &table, pixel_mm));
    for (int64_t i = 0; i < count; i++)
        if (!(fabs(mtf[i]) <= 2 && (i || fabs(mtf[i] - 1) <= 1e-2)))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "MTF, row %" PRId64 ": %g; give 1 at frequency 0, and values from -2 to 2", i + 1,
                            mtf[i]);
    for (int k = 0; k <= STEPS; k++)
        transfer[k] = skg_frequency_table_at(&table, 0.5 / pixel_mm * k / STEPS) / mtf[0];
    return skg_line_spread_fit("MTF", transfer, line, samples);
}
