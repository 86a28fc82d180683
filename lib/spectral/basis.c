/* A basis of attenuation curves, in which materials have few coefficients. */
#include "spectral/compression.h"

#include "core/maths.h"
#include "core/threads.h"

#include <math.h>
#include <string.h>

/* The least weight of an energy, as a share of the greatest: no energy is left out, and those that hardly arrive
 * count for little. */
static const double MIN_WEIGHT = 1e-4;

void skg_basis_release(skg_basis *basis) {
    skg_free(&basis->material);
    skg_free(&basis->mix);
    skg_free(&basis->mu);
    basis->planes = 0;
}

skg_status skg_basis_weigh(const skg_polychromatic *beam, const skg_lengths *points, double *weight) {
    double *passed = NULL, greatest = 0;
    SKG_TRY(skg_alloc(beam->bins, sizeof *passed, "basis", &passed));
    memset(weight, 0, (size_t)beam->bins * sizeof *weight);
    for (int64_t p = 0; p < points->count; p++) {
        const double *exact = points->exact + p * beam->sets;
        skg_transmit(beam, beam->mu, points->lengths + p * beam->materials, passed);
        for (int32_t b = 0; b < beam->bins; b++)
            for (int32_t s = 0; s < beam->sets; s++)
                weight[b] += passed[b] * beam->shares[b * beam->sets + s] / fmax(exact[s], beam->floor);
    }
    for (int32_t b = 0; b < beam->bins; b++) greatest = fmax(greatest, weight[b]);
    for (int32_t b = 0; b < beam->bins; b++) weight[b] = sqrt(fmax(weight[b], MIN_WEIGHT * greatest));
    skg_free(&passed);
    return SKG_OK;
}

static double thickness(const skg_polychromatic *beam, int32_t material) {
    return fmax(fabs(beam->low[material]), fabs(beam->high[material]));
}

/* Removes the component of `column` along a unit vector. It is done twice, because once leaves rounding behind. */
static void take_away(double *column, const double *unit, int32_t count) {
    for (int twice = 0; twice < 2; twice++) {
        const double along = skg_dot_long(count, column, unit);
        for (int32_t i = 0; i < count; i++) column[i] -= along * unit[i];
    }
}

skg_status skg_basis_order(const skg_polychromatic *beam, const double *weight, int32_t first,
                           int32_t *order) {
    const int32_t bins = beam->bins, materials = beam->materials;
    double *rest = NULL;
    SKG_TRY(skg_alloc((int64_t)materials * bins, sizeof *rest, "basis", &rest));
    for (int32_t m = 0; m < materials; m++) {
        order[m] = m;
        for (int32_t b = 0; b < bins; b++)
            rest[m * bins + b] = beam->mu[m * bins + b] * weight[b] * thickness(beam, m);
    }
    for (int32_t k = 0; k < materials; k++) {
        int32_t most = k;
        for (int32_t j = k; j < materials; j++) {
            const double *left = rest + order[j] * bins, *best = rest + order[most] * bins;
            if (k == 0 && order[j] == first) most = j;
            if (k == 0 && order[most] == first) break;
            if (skg_dot_long(bins, left, left) > skg_dot_long(bins, best, best)) most = j;
        }
        const int32_t taken = order[most];
        order[most] = order[k], order[k] = taken;
        double *unit = rest + taken * bins;
        const double length = sqrt(skg_dot_long(bins, unit, unit));
        for (int32_t b = 0; b < bins && length > 0; b++) unit[b] /= length;
        for (int32_t j = k + 1; j < materials; j++) take_away(rest + order[j] * bins, unit, bins);
    }
    skg_free(&rest);
    return SKG_OK;
}

/* The mix of every material: 1 of its own plane if it has one, otherwise by weighted least squares. */
static skg_status mix_materials(const skg_polychromatic *beam, const double *weight, skg_basis *basis) {
    const int32_t bins = beam->bins, planes = basis->planes;
    skg_least_squares system = {0};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_least_squares_create(bins, planes, &system));
    for (int32_t k = 0; k < planes; k++) {
        system.list[k] = k;
        for (int32_t b = 0; b < bins; b++)
            system.a[k * bins + b] = beam->mu[basis->material[k] * bins + b] * weight[b];
    }
    for (int32_t m = 0; m < beam->materials; m++) {
        double *mix = basis->mix + m * planes;
        int32_t own = 0;
        while (own < planes && basis->material[own] != m) own++;
        if (own < planes) {
            mix[own] = 1;
            continue;
        }
        for (int32_t b = 0; b < bins; b++) system.b[b] = beam->mu[m * bins + b] * weight[b];
        skg_least_squares_solve(&system, planes, system.list, mix, NULL);
    }
    for (int32_t m = 0; m < beam->materials; m++)
        for (int32_t k = 0; k < planes; k++)
            for (int32_t b = 0; b < bins; b++)
                basis->mu[m * bins + b] +=
                    basis->mix[m * planes + k] * beam->mu[basis->material[k] * bins + b];
cleanup:
    skg_least_squares_release(&system);
    return status;
}

typedef struct {
    const skg_polychromatic *beam;
    const skg_lengths *points;
    const double *mu;
    skg_nodes all;  /* every bin */
    double *errors; /* [points] */
} measuring;

/* Points of a piece of work of skg_parallel. */
enum { PIECE = 32 };
static skg_status find_errors(void *user, int64_t piece) {
    const measuring *m = user;
    for (int64_t p = piece * PIECE; p < (piece + 1) * PIECE && p < m->points->count; p++)
        m->errors[p] = skg_nodes_error(m->beam, m->mu, &m->all, m->points->lengths + p * m->beam->materials,
                                       m->points->exact + p * m->beam->sets);
    return SKG_OK;
}

/* The greatest error over the points if every bin is used with the attenuation that the planes give. */
static skg_status find_error(const skg_polychromatic *beam, const skg_lengths *points, skg_basis *basis) {
    measuring m = {.beam = beam,
                   .points = points,
                   .mu = basis->mu,
                   .all = {.count = beam->bins, .shares = (double *)beam->shares}};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(beam->bins, sizeof *m.all.bin, "basis", &m.all.bin));
    SKG_TRY_CLEANUP(skg_alloc(points->count, sizeof *m.errors, "basis", &m.errors));
    for (int32_t b = 0; b < beam->bins; b++) m.all.bin[b] = b;
    SKG_TRY_CLEANUP(skg_parallel((points->count + PIECE - 1) / PIECE, find_errors, &m));
    for (int64_t p = 0; p < points->count; p++) basis->error = fmax(basis->error, m.errors[p]);
cleanup:
    skg_free(&m.all.bin);
    skg_free(&m.errors);
    return status;
}

skg_status skg_basis_make(const skg_polychromatic *beam, const skg_lengths *points, const double *weight,
                          const int32_t *order, int32_t planes, skg_basis *basis) {
    skg_status status = SKG_OK;
    *basis = (skg_basis){.planes = planes};
    SKG_TRY_CLEANUP(skg_alloc(planes, sizeof *basis->material, "basis", &basis->material));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)beam->materials * planes, sizeof *basis->mix, "basis", &basis->mix));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)beam->materials * beam->bins, sizeof *basis->mu, "basis", &basis->mu));
    memcpy(basis->material, order, (size_t)planes * sizeof *order);
    SKG_TRY_CLEANUP(mix_materials(beam, weight, basis));
    SKG_TRY_CLEANUP(find_error(beam, points, basis));
cleanup:
    if (status != SKG_OK) skg_basis_release(basis);
    return status;
}
