#include "scatter/smooth.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* Cosines along each side of the first octave that may be empty; standard errors above which an octave is not. */
enum { LEAST = 4 };
static const double SURE = 2;

/* Orthonormal cosines at the middles of `count` places: [k][i]. */
static skg_status make_cosines(int64_t count, double **table) {
    SKG_TRY(skg_alloc(count * count, sizeof **table, "smoothing", table));
    for (int64_t k = 0; k < count; k++)
        for (int64_t i = 0; i < count; i++)
            (*table)[k * count + i] = sqrt((k ? 2.0 : 1.0) / (double)count) *
                                      cos(PI * (double)k * ((double)i + 0.5) / (double)count);
    return SKG_OK;
}

/* The coefficients of one batch. half: [rows][columns] workspace */
static void transform(const skg_cosines *c, const double *across, const double *down, const double *values,
                      double *half, double *out) {
    for (int64_t r = 0; r < c->rows; r++)
        for (int64_t m = 0; m < c->columns; m++) {
            double sum = 0;
            for (int64_t i = 0; i < c->columns; i++)
                sum += values[r * c->columns + i] * across[m * c->columns + i];
            half[r * c->columns + m] = sum;
        }
    for (int64_t n = 0; n < c->rows; n++)
        for (int64_t m = 0; m < c->columns; m++) {
            double sum = 0;
            for (int64_t r = 0; r < c->rows; r++) sum += half[r * c->columns + m] * down[n * c->rows + r];
            out[n * c->columns + m] = sum;
        }
}

/* Mean and variance of the mean of each coefficient. */
static void average(const skg_arrivals *a, const double *all, skg_cosines *c) {
    const int64_t size = c->rows * c->columns;
    const double batches = (double)a->batches;
    for (int64_t k = 0; k < size; k++) {
        double sum = 0, square = 0;
        for (int64_t b = 0; b < a->batches; b++) sum += all[b * size + k];
        for (int64_t b = 0; b < a->batches; b++) {
            const double off = all[b * size + k] - sum / batches;
            square += off * off;
        }
        c->value[k] = sum / batches;
        c->variance[k] = square / (batches * (batches - 1));
    }
}

/* Of the cosines (m, n) with max(m, n) from `first` to before `end`: what they hold beyond noise, and its standard error. */
static double signal_between(const skg_cosines *c, int64_t first, int64_t end, double *error) {
    double sum = 0, fourth = 0;
    for (int64_t n = 0; n < c->rows && n < end; n++)
        for (int64_t m = 0; m < c->columns && m < end; m++) {
            const int64_t k = n * c->columns + m;
            if (m < first && n < first) continue;
            sum += c->value[k] * c->value[k] - c->variance[k];
            fourth += 2 * c->variance[k] * c->variance[k];
        }
    *error = sqrt(fourth);
    return sum;
}

static double variance_before(const skg_cosines *c, int64_t end) {
    double sum = 0;
    for (int64_t n = 0; n < c->rows && n < end; n++)
        for (int64_t m = 0; m < c->columns && m < end; m++) sum += c->variance[n * c->columns + m];
    return sum;
}

static int64_t smaller(int64_t a, int64_t b) {
    return a < b ? a : b;
}

static int64_t longer_side(const skg_cosines *c) {
    return c->columns > c->rows ? c->columns : c->rows;
}

/* Beyond the first octave that holds nothing but noise, nothing is looked for: the noise of all of them together would decide. */
static int64_t last_octave(const skg_cosines *c) {
    const int64_t most = longer_side(c);
    double error = 0;
    for (int64_t end = LEAST; end < most; end *= 2)
        if (signal_between(c, end, smaller(2 * end, most), &error) <= SURE * error)
            return smaller(2 * end, most);
    return most;
}

/* As many along both sides of the detector, up to the grid's own. */
static void choose(skg_cosines *c) {
    const int64_t end = last_octave(c);
    double best = HUGE_VAL;
    for (int64_t kept = 1; kept <= end; kept++) {
        double error = 0;
        const double left = signal_between(c, kept, end, &error), found = variance_before(c, kept) + left;
        if (!(found < best)) continue;
        best = found;
        c->kept[0] = smaller(kept, c->columns);
        c->kept[1] = smaller(kept, c->rows);
        c->bias = (left > 0 ? left : 0) / (double)(c->rows * c->columns);
        c->doubt = error / (double)(c->rows * c->columns);
    }
}

/* Keeps the chosen ones. */
static void finish(skg_cosines *c) {
    const double places = (double)(c->rows * c->columns);
    double variance = 0;
    for (int64_t n = 0; n < c->rows; n++)
        for (int64_t m = 0; m < c->columns; m++) {
            const int64_t k = n * c->columns + m;
            if (m < c->kept[0] && n < c->kept[1])
                variance += c->variance[k];
            else
                c->value[k] = c->variance[k] = 0;
        }
    c->mean = c->value[0] / sqrt(places);
    c->sigma = sqrt(variance / places + c->bias);
}

skg_status skg_cosines_fit(const skg_arrivals *a, skg_cosines *c) {
    const int64_t size = a->rows * a->columns;
    double *across = NULL, *down = NULL, *half = NULL, *all = NULL;
    skg_status status = SKG_OK;
    *c = (skg_cosines){.columns = a->columns, .rows = a->rows};
    SKG_TRY_CLEANUP(make_cosines(a->columns, &across));
    SKG_TRY_CLEANUP(make_cosines(a->rows, &down));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *half, "smoothing", &half));
    SKG_TRY_CLEANUP(skg_alloc(a->batches * size, sizeof *all, "smoothing", &all));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->value, "smoothing", &c->value));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->variance, "smoothing", &c->variance));
    for (int64_t b = 0; b < a->batches; b++)
        transform(c, across, down, a->values + b * size, half, all + b * size);
    average(a, all, c);
    choose(c);
    finish(c);
cleanup:
    skg_free(&across);
    skg_free(&down);
    skg_free(&half);
    skg_free(&all);
    return status;
}

skg_status skg_cosines_like(const skg_cosines *like, const double *values, skg_cosines *c) {
    const int64_t size = like->rows * like->columns;
    double *across = NULL, *down = NULL, *half = NULL;
    skg_status status = SKG_OK;
    *c = (skg_cosines){.columns = like->columns, .rows = like->rows, .kept = {like->kept[0], like->kept[1]}};
    SKG_TRY_CLEANUP(make_cosines(c->columns, &across));
    SKG_TRY_CLEANUP(make_cosines(c->rows, &down));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *half, "smoothing", &half));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->value, "smoothing", &c->value));
    transform(c, across, down, values, half, c->value);
cleanup:
    skg_free(&across);
    skg_free(&down);
    skg_free(&half);
    return status;
}

void skg_cosines_free(skg_cosines *c) {
    skg_free(&c->value);
    skg_free(&c->variance);
}

/* A place of the grid holds the mean of a cosine over it, which is this share of the value at its middle. */
static double of_place(int64_t k, int64_t count) {
    const double x = PI * (double)k / (2 * (double)count);
    return k ? sin(x) / x : 1;
}

/* Cosines of the grid at the middles of `pixels` pixels: [k][i], their squares if asked for. */
static skg_status make_shown(int64_t count, int64_t kept, int64_t pixels, int squares, double **table) {
    SKG_TRY(skg_alloc(kept * pixels, sizeof **table, "smoothing", table));
    for (int64_t k = 0; k < kept; k++)
        for (int64_t i = 0; i < pixels; i++) {
            const double wave = cos(PI * (double)k * ((double)i + 0.5) / (double)pixels) / of_place(k, count);
            const double norm = (k ? 2.0 : 1.0) / (double)count;
            (*table)[k * pixels + i] = squares ? norm * wave * wave : sqrt(norm) * wave;
        }
    return SKG_OK;
}

skg_status skg_cosines_show(const skg_cosines *c, int squares, int64_t rows, int64_t columns, double *image) {
    const double share = (double)(c->rows * c->columns) / (double)(rows * columns);
    const double *from = squares ? c->variance : c->value;
    double *across = NULL, *down = NULL, *half = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(make_shown(c->columns, c->kept[0], columns, squares, &across));
    SKG_TRY_CLEANUP(make_shown(c->rows, c->kept[1], rows, squares, &down));
    SKG_TRY_CLEANUP(skg_alloc(c->kept[1] * columns, sizeof *half, "smoothing", &half));
    for (int64_t n = 0; n < c->kept[1]; n++)
        for (int64_t m = 0; m < c->kept[0]; m++)
            for (int64_t i = 0; i < columns; i++)
                half[n * columns + i] += from[n * c->columns + m] * across[m * columns + i];
    for (int64_t r = 0; r < rows; r++)
        for (int64_t i = 0; i < columns; i++) {
            double sum = squares ? c->bias : 0;
            for (int64_t n = 0; n < c->kept[1]; n++) sum += half[n * columns + i] * down[n * rows + r];
            image[r * columns + i] = sum * (squares ? share * share : share);
        }
cleanup:
    skg_free(&across);
    skg_free(&down);
    skg_free(&half);
    return status;
}
