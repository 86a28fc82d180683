/* Tables from which directions of scattered photons are drawn. */
#include "scatter/interactions.h"

#include "material/scattering.h"
#include "skg_shared.h"

#include <math.h>

/* Points of the angle: s = sin(theta / 2) is the square of even numbers, because Rayleigh scattering is nearly straight on. */
enum { POINTS = 1024 };

/* A row of a table at a place between two. */
static void row_at(const skg_mixture *table, int64_t count, double place, double row[SKG_SCATTER_RANK]) {
    const int64_t i = place < (double)(count - 2) ? (int64_t)place : count - 2;
    const double share = place - (double)i;
    for (int k = 0; k < SKG_SCATTER_RANK; k++)
        row[k] = (double)table[i][k] * (1 - share) + (double)table[i + 1][k] * share;
}

static double value(const double row[SKG_SCATTER_RANK], const double mixture[SKG_SCATTER_RANK]) {
    double sum = 0;
    for (int k = 0; k < SKG_SCATTER_RANK; k++) sum += row[k] * mixture[k];
    return sum > 0 ? sum : 0;
}

/* Compton and Rayleigh cross sections of one mixture at an energy, each over its share of their sum and over the norm of its shape. */
static void shares_of(const skg_scatter_physics *p, double place, const double *mixture, double shares[2]) {
    double rows[4][SKG_SCATTER_RANK];
    row_at(p->compton, p->energies, place, rows[0]);
    row_at(p->rayleigh, p->energies, place, rows[1]);
    row_at(p->compton_shape, p->energies, place, rows[2]);
    row_at(p->rayleigh_shape, p->energies, place, rows[3]);
    const double compton = value(rows[0], mixture), rayleigh = value(rows[1], mixture);
    const double shape[2] = {value(rows[2], mixture), value(rows[3], mixture)};
    const double both = compton + rayleigh;
    shares[0] = both > 0 && shape[0] > 0 ? compton / both / shape[0] : 0;
    shares[1] = both > 0 && shape[1] > 0 ? rayleigh / both / shape[1] : 0;
}

/* Weights of the coefficients in a row of S and in one of F^2 such that their sums are the mean distribution's. */
static void weigh(const skg_scatter_physics *p, double place, const double *mixture,
                  double weights[2][SKG_SCATTER_RANK]) {
    double shares[2];
    const double each = 0.5 / (double)p->materials;
    for (int k = 0; k < SKG_SCATTER_RANK; k++) weights[0][k] = weights[1][k] = 0;
    for (int64_t m = -1; m < p->materials; m++) {
        const double *own = m < 0 ? mixture : p->coefficients[m];
        shares_of(p, place, own, shares);
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            for (int f = 0; f < 2; f++) weights[f][k] += (m < 0 ? 0.5 : each) * shares[f] * own[k];
    }
}

/* The density of s at one energy: that of the solid angle times 4 s / (2 pi), its square's derivative left to the caller. */
static void fill_density(const skg_scatter_physics *p, double kev, double weights[2][SKG_SCATTER_RANK],
                         double *density) {
    const double range = log1p(p->momentum_high / p->momentum_scale);
    for (int i = 0; i <= POINTS; i++) {
        const double t = (double)i / POINTS, s = t * t, cosine = 1 - 2 * s * s;
        const double x = kev / SKG_HC_KEV_ANGSTROM * s;
        const double place = log1p(x / p->momentum_scale) / range * (double)(p->momenta - 1);
        double incoherent[SKG_SCATTER_RANK], coherent[SKG_SCATTER_RANK];
        row_at(p->incoherent, p->momenta, place, incoherent);
        row_at(p->coherent, p->momenta, place, coherent);
        density[i] = (skg_klein_nishina(kev, cosine) * value(incoherent, weights[0]) +
                      skg_thomson(cosine) * value(coherent, weights[1])) *
                     s * t;
    }
}

/* Cosines between which the density holds equal shares. sums: [POINTS + 1] workspace */
static void split(const double *density, double *sums, float *row) {
    sums[0] = 0;
    for (int i = 1; i <= POINTS; i++) sums[i] = sums[i - 1] + 0.5 * (density[i - 1] + density[i]);
    int i = 0;
    for (int k = 0; k <= SKG_SCATTER_ANGLES; k++) {
        const double wanted = sums[POINTS] * (double)k / SKG_SCATTER_ANGLES;
        while (i < POINTS - 1 && sums[i + 1] < wanted) i++;
        const double step = sums[i + 1] - sums[i];
        const double t = ((double)i + (step > 0 ? (wanted - sums[i]) / step : 0)) / POINTS;
        row[SKG_SCATTER_ANGLES - k] = (float)(1 - 2 * t * t * t * t);
    }
    row[0] = -1;
    row[SKG_SCATTER_ANGLES] = 1;
}

skg_status skg_angles_make(const skg_scatter_physics *p, const double mixture[SKG_SCATTER_RANK],
                           float *table) {
    double *density = NULL;
    SKG_TRY(skg_alloc(2 * (POINTS + 1), sizeof *density, "angles of scattering", &density));
    for (int r = 0; r < SKG_ANGLE_ROWS; r++) {
        const double share = (double)r / (SKG_ANGLE_ROWS - 1), place = share * (double)(p->energies - 1);
        double weights[2][SKG_SCATTER_RANK];
        weigh(p, place, mixture, weights);
        fill_density(p, p->low_kev * exp(share * log(p->high_kev / p->low_kev)), weights, density);
        split(density, density + POINTS + 1, table + (int64_t)r * (SKG_SCATTER_ANGLES + 1));
    }
    skg_free(&density);
    return SKG_OK;
}
