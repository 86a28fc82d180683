/* Positions along a series of frames, by orthonormal functions. */
#include "scatter/smoothing.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

enum { POWERS = 3 };

/* A power or a cosine. */
static double raw(int64_t k, double t) {
    return k == 0 ? 1 : k == 1 ? t : k == 2 ? t * t : cos(PI * (double)(k - POWERS + 1) * t);
}

static double dot(int64_t count, const double *a, const double *b) {
    double sum = 0;
    for (int64_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

static void subtract(int64_t count, double share, const double *from, double *to) {
    for (int64_t i = 0; i < count; i++) to[i] -= share * from[i];
}

/* Gram and Schmidt, twice for rounding. */
static void make_orthonormal(skg_along *a, int64_t k) {
    double *own = a->values + k * a->places, *mixture = a->mixture + k * a->count;
    for (int twice = 0; twice < 2; twice++)
        for (int64_t l = 0; l < k; l++) {
            const double share = dot(a->places, own, a->values + l * a->places);
            subtract(a->places, share, a->values + l * a->places, own);
            subtract(a->count, share, a->mixture + l * a->count, mixture);
        }
    const double length = sqrt(dot(a->places, own, own));
    for (int64_t i = 0; i < a->places; i++) own[i] /= length;
    for (int64_t i = 0; i < a->count; i++) mixture[i] /= length;
}

skg_status skg_along_make(int64_t places, const double *at, skg_along *a) {
    *a = (skg_along){.places = places, .count = 3 * places / 4};
    SKG_TRY(skg_alloc(a->count * places, sizeof *a->values, "series", &a->values));
    SKG_TRY(skg_alloc(a->count * a->count, sizeof *a->mixture, "series", &a->mixture));
    for (int64_t k = 0; k < a->count; k++) {
        for (int64_t i = 0; i < places; i++) a->values[k * places + i] = raw(k, at[i]);
        a->mixture[k * a->count + k] = 1;
        make_orthonormal(a, k);
    }
    return SKG_OK;
}

void skg_along_free(skg_along *a) {
    skg_free(&a->values);
    skg_free(&a->mixture);
}

void skg_along_at(const skg_along *a, double t, double *values) {
    for (int64_t k = 0; k < a->count; k++) {
        values[k] = 0;
        for (int64_t l = 0; l <= k; l++) values[k] += a->mixture[k * a->count + l] * raw(l, t);
    }
}
