/* Fits the scatter of a series of frames jointly. */
#include "scatter/smoothing.h"

#include <math.h>
#include <string.h>

static int64_t size_of(const skg_joint *j) {
    return j->rows * j->columns;
}

static int64_t order_of(const skg_joint *j, int64_t l, int64_t k) {
    return (l + 1) * (k % j->columns + 1) * (k / j->columns + 1);
}

/* Mean and variance of the coefficients of a function along the series. each: [batches] workspace */
static void average(skg_joint *j, int64_t l, const double *const *coefficients, double *each) {
    const int64_t size = size_of(j), places = j->along.places;
    const double *along = j->along.values + l * places, batches = (double)j->batches;
    for (int64_t k = 0; k < size; k++) {
        double sum = 0, square = 0;
        for (int64_t b = 0; b < j->batches; b++) {
            each[b] = 0;
            for (int64_t i = 0; i < places; i++) each[b] += along[i] * coefficients[i][b * size + k];
            sum += each[b];
        }
        for (int64_t b = 0; b < j->batches; b++)
            square += (each[b] - sum / batches) * (each[b] - sum / batches);
        j->value[l * size + k] = sum / batches;
        j->of_each[l * size + k] = square / (batches * (batches - 1));
    }
}

static skg_status choose(skg_joint *j) {
    const int64_t size = size_of(j), all = j->along.count * size;
    const double places = (double)(size * j->along.places);
    double variance = 0;
    int64_t *orders = NULL;
    double *shares = NULL;
    skg_choice choice;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(all, sizeof *orders, "series", &orders));
    SKG_TRY_CLEANUP(skg_alloc(all, sizeof *shares, "series", &shares));
    for (int64_t i = 0; i < all; i++) orders[i] = order_of(j, i / size, i % size);
    SKG_TRY_CLEANUP(skg_choose_order(all, orders, j->value, j->of_each, shares, &choice));
    for (int64_t i = 0; i < all; i++) j->value[i] *= shares[i], j->of_each[i] *= shares[i] * shares[i];
    j->order = choice.order;
    j->kept = choice.order < j->along.count ? choice.order : j->along.count;
    j->bias = choice.bias / places;
    for (int64_t i = 0; i < all; i++)
        if (order_of(j, i / size, i % size) <= choice.order)
            variance += j->of_each[i];
        else
            j->value[i] = j->of_each[i] = 0;
    j->sigma = sqrt(variance / places + j->bias);
cleanup:
    skg_free(&shares);
    skg_free(&orders);
    return status;
}

/* The mean of a place, from the first coefficients of all frames. */
static double mean_of(const skg_joint *j, const double *const *coefficients) {
    const int64_t size = size_of(j);
    double sum = 0;
    for (int64_t i = 0; i < j->along.places; i++)
        for (int64_t b = 0; b < j->batches; b++) sum += coefficients[i][b * size];
    return sum / ((double)(j->along.places * j->batches) * sqrt((double)size));
}

skg_status skg_joint_fit(int64_t batches, int64_t columns, int64_t rows, int64_t frames, const double *at,
                         const double *const *coefficients, skg_joint *j) {
    double *each = NULL;
    skg_status status = SKG_OK;
    *j = (skg_joint){.batches = batches, .columns = columns, .rows = rows};
    SKG_TRY(skg_along_make(frames, at, &j->along));
    SKG_TRY(skg_alloc(j->along.count * size_of(j), sizeof *j->value, "series", &j->value));
    SKG_TRY(skg_alloc(j->along.count * size_of(j), sizeof *j->of_each, "series", &j->of_each));
    SKG_TRY(skg_alloc(batches, sizeof *each, "series", &each));
    for (int64_t l = 0; l < j->along.count; l++) average(j, l, coefficients, each);
    j->mean = mean_of(j, coefficients);
    status = choose(j);
    skg_free(&each);
    return status;
}

void skg_joint_free(skg_joint *j) {
    skg_along_free(&j->along);
    skg_free(&j->value);
    skg_free(&j->of_each);
}

/* Coefficients and their variances at t. */
static skg_status mix(const skg_joint *j, double t, double *value, double *variance) {
    const int64_t size = size_of(j);
    double *along = NULL;
    SKG_TRY(skg_alloc(j->along.count, sizeof *along, "series", &along));
    skg_along_at(&j->along, t, along);
    memset(value, 0, (size_t)size * sizeof *value);
    memset(variance, 0, (size_t)size * sizeof *variance);
    for (int64_t l = 0; l < j->kept; l++)
        for (int64_t k = 0; k < size; k++) {
            value[k] += along[l] * j->value[l * size + k];
            variance[k] += along[l] * along[l] * j->of_each[l * size + k];
        }
    skg_free(&along);
    return SKG_OK;
}

skg_status skg_joint_at(const skg_joint *j, double t, skg_cosines *c) {
    const int64_t size = size_of(j);
    *c = (skg_cosines){.columns = j->columns, .rows = j->rows, .bias = j->bias};
    SKG_TRY(skg_alloc(size, sizeof *c->value, "smoothing", &c->value));
    SKG_TRY(skg_alloc(size, sizeof *c->variance, "smoothing", &c->variance));
    SKG_TRY(skg_alloc(size, sizeof *c->spread, "smoothing", &c->spread));
    SKG_TRY(mix(j, t, c->value, c->variance));
    skg_cosines_complete(c, j->order);
    return SKG_OK;
}

skg_status skg_joint_compare(const skg_joint *j, double t, const double *coefficients, double *square,
                             double *error) {
    const int64_t size = size_of(j);
    const double batches = (double)j->batches, places = (double)size;
    double *value = NULL, sum = 0, fourth = 0;
    SKG_TRY(skg_alloc(2 * size, sizeof *value, "series", &value));
    const skg_status status = mix(j, t, value, value + size);
    for (int64_t k = 0; status == SKG_OK && k < size; k++) {
        if (!(value[size + k] > 0)) continue;
        double mean = 0, spread = 0;
        for (int64_t b = 0; b < j->batches; b++) mean += coefficients[b * size + k] / batches;
        for (int64_t b = 0; b < j->batches; b++)
            spread += (coefficients[b * size + k] - mean) * (coefficients[b * size + k] - mean);
        const double noise = spread / (batches * (batches - 1)) + value[size + k];
        sum += (mean - value[k]) * (mean - value[k]) - noise;
        fourth += 2 * noise * noise;
    }
    skg_free(&value);
    *square = sum / places;
    *error = sqrt(fourth) / places;
    return status;
}
