/* Polynomials over directions, to which shades are fitted. */
#include "spectral/shading.h"

#include "core/maths.h"
#include "material/material.h"

#include <math.h>
#include <string.h>

/* Directions are taken until what is left of any state is below this, in the logarithm of what is transmitted. */
static const double LEFT = 2e-4;
/* The least weight of an energy in the squares, as a share of the greatest. */
static const double MIN_WEIGHT = 1e-4;
/* Energies count as in the open beam and behind so much water, g/cm2, in equal parts: matter leaves the high ones. */
enum { DEPTHS = 3 };
static const double WATER[DEPTHS] = {0, 10, 30};

static void weigh(const skg_spectrum *spectrum, double *weight) {
    static const skg_mass_fraction water[] = {{1, 0.111894}, {8, 0.888106}};
    double most = 0, sum = 0;
    for (int64_t b = 0; b < spectrum->count; b++) weight[b] = 0;
    for (int d = 0; d < DEPTHS; d++) {
        double all = 0;
        for (int pass = 0; pass < 2; pass++)
            for (int64_t b = 0; b < spectrum->count; b++) {
                double sections[SKG_PROCESSES];
                skg_mixed_sections(2, water, spectrum->energy_kev[b], sections);
                const double kev = spectrum->photons[b] * spectrum->energy_kev[b] *
                                   exp(-WATER[d] * skg_total_section(sections));
                if (pass == 0) all += kev;
                if (pass == 1 && all > 0) weight[b] += kev / all / DEPTHS;
            }
    }
    for (int64_t b = 0; b < spectrum->count; b++) most = fmax(most, weight[b]);
    for (int64_t b = 0; b < spectrum->count; b++) sum += weight[b] = fmax(weight[b], MIN_WEIGHT * most);
    for (int64_t b = 0; b < spectrum->count; b++) weight[b] = sqrt(weight[b] / sum);
}

skg_status skg_directions_create(const skg_spectrum *spectrum, int64_t states, skg_directions *d) {
    skg_status status = SKG_OK;
    *d = (skg_directions){.states = states, .bins = spectrum->count};
    SKG_TRY_CLEANUP(skg_alloc(d->bins, sizeof(double), "shades", &d->weight));
    SKG_TRY_CLEANUP(skg_alloc(states * d->bins, sizeof(double), "shades", &d->losses));
    SKG_TRY_CLEANUP(skg_alloc(states, sizeof(double), "shades", &d->scale));
    SKG_TRY_CLEANUP(skg_alloc(SKG_DIRECTIONS_MAX * states, sizeof(double), "shades", &d->amounts));
    SKG_TRY_CLEANUP(skg_alloc(SKG_DIRECTIONS_MAX * d->bins, sizeof(double), "shades", &d->unit));
    for (int64_t s = 0; s < states; s++) d->scale[s] = 1;
    weigh(spectrum, d->weight);
    return SKG_OK;
cleanup:
    skg_directions_release(d);
    return status;
}

void skg_directions_release(skg_directions *d) {
    skg_free(&d->weight);
    skg_free(&d->losses);
    skg_free(&d->scale);
    skg_free(&d->amounts);
    skg_free(&d->unit);
}

/* Takes the state of which most is left as the next direction, and its component from all (Gram and Schmidt). */
void skg_directions_find(skg_directions *d) {
    for (int64_t k = 0; k < d->states * d->bins; k++) d->losses[k] *= d->weight[k % d->bins];
    for (;;) {
        int64_t worst = 0;
        double most = 0;
        for (int64_t s = 0; s < d->states; s++) {
            const double *rest = d->losses + s * d->bins;
            const double left = d->scale[s] * sqrt(skg_dot_long(d->bins, rest, rest));
            if (left > most) most = left, worst = s;
        }
        d->error = most;
        if (most < LEFT || d->count == SKG_DIRECTIONS_MAX) break;
        double *unit = d->unit + d->count * d->bins;
        memcpy(unit, d->losses + worst * d->bins, (size_t)d->bins * sizeof *unit);
        const double length = sqrt(skg_dot_long(d->bins, unit, unit));
        for (int64_t b = 0; b < d->bins; b++) unit[b] /= length;
        for (int64_t s = 0; s < d->states; s++) {
            double *rest = d->losses + s * d->bins;
            const double along = skg_dot_long(d->bins, rest, unit);
            d->amounts[d->count * d->states + s] = along;
            for (int64_t b = 0; b < d->bins; b++) rest[b] -= along * unit[b];
        }
        d->count++;
    }
    for (int64_t k = 0; k < d->count * d->bins; k++) d->unit[k] /= d->weight[k % d->bins];
}

double skg_fit_point(int state) {
    return cos(SKG_PI * (state + 0.5) / SKG_FIT_POINTS);
}

/* Sums over Chebyshev's polynomials, as powers of z. */
double skg_polynomial_fit(const double values[SKG_FIT_POINTS], double terms[SKG_FIT_TERMS]) {
    double power[SKG_FIT_TERMS][SKG_FIT_TERMS] = {{1}, {0, 1}}; /* [degree][term] */
    double error = 0;
    for (int d = 2; d < SKG_FIT_TERMS; d++)
        for (int t = 0; t < SKG_FIT_TERMS; t++)
            power[d][t] = (t ? 2 * power[d - 1][t - 1] : 0) - power[d - 2][t];
    for (int t = 0; t < SKG_FIT_TERMS; t++) terms[t] = 0;
    for (int d = 0; d < SKG_FIT_TERMS; d++) {
        double sum = 0;
        for (int s = 0; s < SKG_FIT_POINTS; s++) sum += values[s] * cos(d * acos(skg_fit_point(s)));
        for (int t = 0; t < SKG_FIT_TERMS; t++)
            terms[t] += sum * (d ? 2.0 : 1.0) / SKG_FIT_POINTS * power[d][t];
    }
    for (int s = 0; s < SKG_FIT_POINTS; s++) {
        double value = 0;
        for (int t = SKG_FIT_TERMS - 1; t >= 0; t--) value = value * skg_fit_point(s) + terms[t];
        error = fmax(error, fabs(value - values[s]));
    }
    return error;
}
