/* Cross sections and angles of free atoms, tabulated for photons that are followed one by one. */
#include "matter.h"

#include "material/scattering.h"
#include "support/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void try(skg_status status, const char *what) {
    if (status == SKG_OK) return;
    fprintf(stderr, "%s: %s\n", what, skg_last_error());
    exit(1);
}

static double at(const double *table, int count, double share) {
    const double place = fmin(fmax(share, 0), 1) * count;
    const int i = place < count - 1 ? (int)place : count - 1;
    return table[i] + (place - i) * (table[i + 1] - table[i]);
}

double matter_at_energy(const double *table, const matter *m, double kev) {
    return at(table, MATTER_ENERGIES, (kev - MATTER_LOWEST_KEV) / (m->kev - MATTER_LOWEST_KEV));
}

double matter_ratio(double kev, double cosine) {
    return 1 / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
}

static double momentum_of(double kev, double cosine) {
    return kev / SKG_HC_KEV_ANGSTROM * sqrt(fmax(1 - cosine, 0) / 2);
}

/* Klein and Nishina times the scattering function, at most 1. */
static double compton_chance(const matter *m, double kev, double cosine) {
    const double r = matter_ratio(kev, cosine);
    return 0.5 * r * r * (r + 1 / r - 1 + cosine * cosine) *
           at(m->incoherent, MATTER_MOMENTA, sqrt(momentum_of(kev, cosine) / m->momentum));
}

static double rayleigh_chance(const matter *m, double kev, double cosine) {
    return 0.5 * (1 + cosine * cosine) *
           at(m->coherent, MATTER_MOMENTA, sqrt(momentum_of(kev, cosine) / m->momentum));
}

/* The integrals of both over the cosine: of Rayleigh scattering over the square of the momentum transfer, in which it is smooth. */
static void normalise(matter *m) {
    enum { STEPS = 8000 };
    for (int i = 0; i <= MATTER_NORMS; i++) {
        const double kev = MATTER_LOWEST_KEV + (m->kev - MATTER_LOWEST_KEV) * i / MATTER_NORMS;
        m->compton_norm[i] = m->rayleigh_norm[i] = 0;
        for (int s = 0; s < STEPS; s++) {
            const double x = (s + 0.5) / STEPS, weight = 4 * x / STEPS; /* cosine 1 - 2 x^2 */
            m->compton_norm[i] += weight * compton_chance(m, kev, 1 - 2 * x * x);
            m->rayleigh_norm[i] += weight * rayleigh_chance(m, kev, 1 - 2 * x * x);
        }
    }
}

/* Momentum transfer and its square of a row, in units of the first one's. */
static double row_square(int i) {
    return (double)i * i;
}

static double row_fourth(int i) {
    return row_square(i) * row_square(i);
}

void matter_make(const char *name, double density, double kev, matter *m) {
    skg_material *material = NULL, *dense = NULL;
    try(skg_material_create_named(name, &material), name);
    try(density > 0 ? skg_material_create_at_density(material, density, &dense)
                    : (skg_material_retain(material), dense = material, SKG_OK),
        name);
    m->kev = kev;
    m->momentum = kev / SKG_HC_KEV_ANGSTROM;
    for (int i = 0; i <= MATTER_ENERGIES; i++) {
        const double energy = MATTER_LOWEST_KEV + (kev - MATTER_LOWEST_KEV) * i / MATTER_ENERGIES;
        skg_coefficients c;
        double per_cm = 0;
        skg_coefficients_init(&c);
        try(skg_material_coefficients_get(dense, energy, &c), name);
        try(skg_material_attenuation_get(dense, energy, &per_cm), name);
        m->total[i] = per_cm / 10, m->compton[i] = c.compton / c.total, m->rayleigh[i] = c.rayleigh / c.total;
        m->pairs[i] = c.pair / c.total;
    }
    for (int i = 0; i <= MATTER_MOMENTA; i++)
        try(skg_scattering_factors(dense, m->momentum * row_square(i) / row_square(MATTER_MOMENTA),
                                   &m->coherent[i], &m->incoherent[i]),
            name);
    const double most[2] = {m->incoherent[MATTER_MOMENTA], m->coherent[0]};
    for (int i = 0; i <= MATTER_MOMENTA; i++) {
        m->incoherent[i] /= most[0], m->coherent[i] /= most[1];
        m->sum[i] = i ? m->sum[i - 1] +
                            0.5 * (m->coherent[i] + m->coherent[i - 1]) * (row_fourth(i) - row_fourth(i - 1))
                      : 0;
    }
    normalise(m);
    skg_material_release(&material);
    skg_material_release(&dense);
}

static double norm_at(const double *table, const matter *m, double kev) {
    return at(table, MATTER_NORMS, (kev - MATTER_LOWEST_KEV) / (m->kev - MATTER_LOWEST_KEV));
}

double matter_compton(const matter *m, double kev, double cosine) {
    return compton_chance(m, kev, cosine) / norm_at(m->compton_norm, m, kev);
}

double matter_rayleigh(const matter *m, double kev, double cosine) {
    return rayleigh_chance(m, kev, cosine) / norm_at(m->rayleigh_norm, m, kev);
}

/* A cosine of Rayleigh scattering but for its factor (1 + cosine^2) / 2: by the form factors' distribution of the squared momentum
 * transfer, which is even within a step of the table. */
static double draw_coherent(const matter *m, double kev, uint64_t *seed) {
    const double most = kev / m->kev * row_square(MATTER_MOMENTA); /* in units of the first row's */
    const int last = most < row_square(MATTER_MOMENTA) ? (int)sqrt(most) : MATTER_MOMENTA - 1;
    const double part = (most * most - row_fourth(last)) / (row_fourth(last + 1) - row_fourth(last));
    const double end = m->sum[last] + part * (m->sum[last + 1] - m->sum[last]), at = draw(seed, 0, end);
    int low = 0, high = last + 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (m->sum[middle] <= at)
            low = middle;
        else
            high = middle;
    }
    const double square = row_fourth(low) + (at - m->sum[low]) / (m->sum[high] - m->sum[low]) *
                                                (row_fourth(high) - row_fourth(low));
    return 1 - 2 * fmin(square / (most * most), 1);
}

double matter_draw(const matter *m, double kev, int is_compton, uint64_t *seed) {
    for (;;) {
        const double cosine = is_compton ? draw(seed, -1, 1) : draw_coherent(m, kev, seed);
        const double chance = is_compton ? compton_chance(m, kev, cosine) : 0.5 * (1 + cosine * cosine);
        if (draw(seed, 0, 1) < chance) return cosine;
    }
}

void matter_anywhere(double way[3], uint64_t *seed) {
    const double cosine = draw(seed, -1, 1), azimuth = draw(seed, 0, 2 * 3.14159265358979323846);
    way[0] = sqrt(1 - cosine * cosine) * cos(azimuth), way[1] = sqrt(1 - cosine * cosine) * sin(azimuth);
    way[2] = cosine;
}

void matter_turn(double way[3], double cosine, double azimuth) {
    const double sine = sqrt(fmax(1 - cosine * cosine, 0)), axis = way[2] * way[2] < 0.8;
    double a[3] = {way[1] * axis, axis != 0 ? -way[0] : way[2], axis != 0 ? 0 : -way[1]}, b[3], length = 0;
    for (int k = 0; k < 3; k++) length += a[k] * a[k];
    for (int k = 0; k < 3; k++) a[k] /= sqrt(length);
    for (int k = 0; k < 3; k++) b[k] = way[(k + 1) % 3] * a[(k + 2) % 3] - way[(k + 2) % 3] * a[(k + 1) % 3];
    for (int k = 0; k < 3; k++) way[k] = cosine * way[k] + sine * (cos(azimuth) * a[k] + sin(azimuth) * b[k]);
}
