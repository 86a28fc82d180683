/* Smooths what has arrived, by as much as its noise says. */
#include "scatter/smoothing.h"

#include "core/maths.h"
#include "core/threads.h"

#include <math.h>
#include <string.h>

/* Order of the cosines that show how the variance changes over the detector, and the least share of its mean. */
enum { BROAD = 12 };
static const double MIN_SHARE = 0.25;

/* Orthonormal cosines at the middles of `count` places: [k][i]. */
static skg_status make_cosines(int64_t count, double **table) {
    SKG_TRY(skg_alloc(count * count, sizeof **table, "smoothing", table));
    for (int64_t k = 0; k < count; k++)
        for (int64_t i = 0; i < count; i++)
            (*table)[k * count + i] = sqrt((k ? 2.0 : 1.0) / (double)count) *
                                      cos(SKG_PI * (double)k * ((double)i + 0.5) / (double)count);
    return SKG_OK;
}

/* A place of the grid holds the mean of a cosine over it, which is this share of the value at its middle. */
static double of_place(int64_t k, int64_t count) {
    const double x = SKG_PI * (double)k / (2 * (double)count);
    return k ? sin(x) / x : 1;
}

/* The coefficients of places. half: [rows][columns] workspace */
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

skg_status skg_cosines_of(int64_t columns, int64_t rows, int64_t count, const double *values,
                          double *coefficients) {
    const skg_cosines c = {.columns = columns, .rows = rows};
    const int64_t size = rows * columns;
    double *across = NULL, *down = NULL, *half = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(make_cosines(columns, &across));
    SKG_TRY_CLEANUP(make_cosines(rows, &down));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *half, "smoothing", &half));
    for (int64_t b = 0; b < count; b++)
        transform(&c, across, down, values + b * size, half, coefficients + b * size);
cleanup:
    skg_free(&across);
    skg_free(&down);
    skg_free(&half);
    return status;
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

/* Along both sides of the detector the same. */
static int64_t order_of(const skg_cosines *c, int64_t k) {
    return (k % c->columns + 1) * (k / c->columns + 1);
}

/* A coefficient of means over places over that of the function itself. */
static double of_places(const skg_cosines *c, int64_t k) {
    return of_place(k % c->columns, c->columns) * of_place(k / c->columns, c->rows);
}

/* From coefficients of means over places to those of the function itself. all: of the batches, too */
static void sharpen(int64_t batches, double *all, skg_cosines *c) {
    const int64_t size = c->rows * c->columns;
    for (int64_t k = 0; k < size; k++) {
        const double share = of_places(c, k);
        c->value[k] /= share;
        c->variance[k] /= share * share;
        for (int64_t b = 0; b < batches; b++) all[b * size + k] /= share;
    }
}

/* Keeps the cosines up to an order. */
static void keep(skg_cosines *c, int64_t order) {
    const double places = (double)(c->rows * c->columns);
    double variance = 0;
    c->kept[0] = order < c->columns ? order : c->columns;
    c->kept[1] = order < c->rows ? order : c->rows;
    for (int64_t k = 0; k < c->rows * c->columns; k++)
        if (order_of(c, k) <= order)
            variance += c->variance[k], c->count++;
        else
            c->value[k] = c->variance[k] = 0;
    c->mean = c->value[0] / sqrt(places);
    c->sigma = sqrt(variance / places + c->bias);
}

void skg_cosines_complete(skg_cosines *c, int64_t order) {
    const double places = (double)(c->rows * c->columns);
    double variance = 0;
    sharpen(0, NULL, c);
    keep(c, order);
    for (int64_t k = 0; k < c->rows * c->columns; k++) variance += c->variance[k];
    c->spread[0] = variance / sqrt(places);
}

/* The smooth function of one batch in the places, from its coefficients. half: [rows][columns] workspace */
static void transform_back(const skg_cosines *c, const double *across, const double *down, const double *from,
                           double *half, double *out) {
    memset(half, 0, (size_t)(c->rows * c->columns) * sizeof *half);
    memset(out, 0, (size_t)(c->rows * c->columns) * sizeof *out);
    for (int64_t n = 0; n < c->kept[1]; n++)
        for (int64_t m = 0; m < c->kept[0]; m++) {
            if (!(c->variance[n * c->columns + m] > 0)) continue;
            for (int64_t i = 0; i < c->columns; i++)
                half[n * c->columns + i] += from[n * c->columns + m] * across[m * c->columns + i];
        }
    for (int64_t r = 0; r < c->rows; r++)
        for (int64_t n = 0; n < c->kept[1]; n++)
            for (int64_t i = 0; i < c->columns; i++)
                out[r * c->columns + i] += half[n * c->columns + i] * down[n * c->rows + r];
}

/* How the variance changes over the detector: of the batches' smooth functions in the places, as broad cosines. Single places are
 * known to a quarter from so few batches. all: coefficients of the batches; work: [3][rows][columns] */
static void find_spread(const skg_arrivals *a, const double *across, const double *down, const double *all,
                        double *work, skg_cosines *c) {
    const int64_t size = c->rows * c->columns;
    const double batches = (double)a->batches;
    double *half = work, *own = work + size, *squares = work + 2 * size;
    memset(squares, 0, (size_t)size * sizeof *squares);
    for (int64_t b = 0; b < a->batches; b++) {
        transform_back(c, across, down, all + b * size, half, own);
        for (int64_t p = 0; p < size; p++) squares[p] += own[p] * own[p];
    }
    transform_back(c, across, down, c->value, half, own);
    for (int64_t p = 0; p < size; p++)
        squares[p] = fmax(squares[p] - batches * own[p] * own[p], 0) / (batches * (batches - 1));
    transform(c, across, down, squares, half, c->spread);
    for (int64_t k = 0; k < size; k++)
        if (order_of(c, k) > BROAD) c->spread[k] = 0;
}

static skg_status fit(const skg_arrivals *a, const double *across, const double *down, double *work,
                      double *all, skg_cosines *c) {
    const int64_t size = a->rows * a->columns;
    const double places = (double)size;
    skg_choice choice;
    int64_t *orders = NULL;
    for (int64_t b = 0; b < a->batches; b++)
        transform(c, across, down, a->values + b * size, work, all + b * size);
    average(a, all, c);
    SKG_TRY(skg_alloc(size, sizeof *orders, "smoothing", &orders));
    for (int64_t k = 0; k < size; k++) orders[k] = order_of(c, k);
    const skg_status status = skg_choose_order(size, orders, c->value, c->variance, c->share, &choice);
    skg_free(&orders);
    if (status != SKG_OK) return status;
    c->bias = choice.bias / places;
    c->doubt = choice.doubt / places;
    for (int64_t k = 0; k < size; k++) {
        c->value[k] *= c->share[k], c->variance[k] *= c->share[k] * c->share[k];
        for (int64_t b = 0; b < a->batches; b++) all[b * size + k] *= c->share[k];
    }
    sharpen(a->batches, all, c);
    keep(c, choice.order);
    find_spread(a, across, down, all, work, c);
    return SKG_OK;
}

skg_status skg_cosines_fit(const skg_arrivals *a, skg_cosines *c) {
    const int64_t size = a->rows * a->columns;
    double *across = NULL, *down = NULL, *work = NULL, *all = NULL;
    skg_status status = SKG_OK;
    *c = (skg_cosines){.columns = a->columns, .rows = a->rows};
    SKG_TRY_CLEANUP(make_cosines(a->columns, &across));
    SKG_TRY_CLEANUP(make_cosines(a->rows, &down));
    SKG_TRY_CLEANUP(skg_alloc(3 * size, sizeof *work, "smoothing", &work));
    SKG_TRY_CLEANUP(skg_alloc(a->batches * size, sizeof *all, "smoothing", &all));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->value, "smoothing", &c->value));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->variance, "smoothing", &c->variance));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->share, "smoothing", &c->share));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *c->spread, "smoothing", &c->spread));
    status = fit(a, across, down, work, all, c);
cleanup:
    skg_free(&across);
    skg_free(&down);
    skg_free(&work);
    skg_free(&all);
    return status;
}

skg_status skg_cosines_like(const skg_cosines *like, const double *values, skg_cosines *c) {
    const int64_t size = like->rows * like->columns;
    *c = (skg_cosines){.columns = like->columns, .rows = like->rows, .kept = {like->kept[0], like->kept[1]}};
    SKG_TRY(skg_alloc(size, sizeof *c->value, "smoothing", &c->value));
    SKG_TRY(skg_cosines_of(c->columns, c->rows, 1, values, c->value));
    for (int64_t k = 0; k < size; k++) c->value[k] *= like->share[k] / of_places(c, k);
    return SKG_OK;
}

void skg_cosines_free(skg_cosines *c) {
    skg_free(&c->value);
    skg_free(&c->variance);
    skg_free(&c->share);
    skg_free(&c->spread);
}

/* Cosines of the grid at the middles of `pixels` pixels: [k][i]. */
static skg_status make_shown(int64_t count, int64_t kept, int64_t pixels, double **table) {
    SKG_TRY(skg_alloc(kept * pixels, sizeof **table, "smoothing", table));
    for (int64_t k = 0; k < kept; k++)
        for (int64_t i = 0; i < pixels; i++)
            (*table)[k * pixels + i] = sqrt((k ? 2.0 : 1.0) / (double)count) *
                                       cos(SKG_PI * (double)k * ((double)i + 0.5) / (double)pixels);
    return SKG_OK;
}

/* An image of cosines. half: [kept][columns] sums along each row of cosines; down: [kept][rows] */
typedef struct {
    const skg_cosines *of;
    int squares;
    int64_t kept, rows, columns;
    const double *half, *down;
    double *image;
} shown;

/* A row at a time: its sums do not wait for one another. */
static skg_status show_row(void *user, int64_t r) {
    const shown *s = user;
    const skg_cosines *c = s->of;
    const double share = (double)(c->rows * c->columns) / (double)(s->rows * s->columns);
    const double least = s->squares ? MIN_SHARE * c->spread[0] / sqrt((double)(c->rows * c->columns)) : 0;
    double *row = s->image + r * s->columns;
    memset(row, 0, (size_t)s->columns * sizeof *row);
    for (int64_t n = 0; n < s->kept; n++)
        for (int64_t i = 0; i < s->columns; i++)
            row[i] += s->half[n * s->columns + i] * s->down[n * s->rows + r];
    for (int64_t i = 0; i < s->columns; i++)
        row[i] = s->squares ? (skg_greater(row[i], least) + c->bias) * share * share : row[i] * share;
    return SKG_OK;
}

skg_status skg_cosines_show(const skg_cosines *c, int squares, int64_t rows, int64_t columns, double *image) {
    const double *from = squares ? c->spread : c->value;
    const int64_t across_kept = squares ? (c->columns < BROAD ? c->columns : BROAD) : c->kept[0],
                  down_kept = squares ? (c->rows < BROAD ? c->rows : BROAD) : c->kept[1];
    double *across = NULL, *down = NULL, *half = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(make_shown(c->columns, across_kept, columns, &across));
    SKG_TRY_CLEANUP(make_shown(c->rows, down_kept, rows, &down));
    SKG_TRY_CLEANUP(skg_alloc(down_kept * columns, sizeof *half, "smoothing", &half));
    for (int64_t n = 0; n < down_kept; n++)
        for (int64_t m = 0; m < across_kept; m++)
            for (int64_t i = 0; i < columns; i++)
                half[n * columns + i] += from[n * c->columns + m] * across[m * columns + i];
    shown s = {c, squares, down_kept, rows, columns, half, down, image};
    status = skg_parallel(rows, show_row, &s);
cleanup:
    skg_free(&across);
    skg_free(&down);
    skg_free(&half);
    return status;
}
