/* Tabulates cross sections and angles of each material by energy. */
#include "scatter/interactions.h"
#include "scatter/voxels.h"

#include "core/text.h"
#include "material/scattering.h"

#include <string.h>

/* The longest steps of the grids in ln E and in ln(1 + x/scale). Photo absorption falls like E^-3.2, which a straight line over
 * a step misses by 10/8 step^2. */
static const double ENERGY_STEP = 0.012, MOMENTUM_STEP = 0.01;
static const double MOMENTUM_SCALE = 0.1; /* 1/Angstrom: where F of light atoms begins to fall */

/* The shapes are compared, and momentum transfers weighted, at one energy of EVERY. */
enum { EVERY = 8 };
static const double ROUNDING_OF_FLOATS = 1e-6;

/* Errors of attenuation and of angles with which there are coefficients enough. The worst of a material, at one energy, by one process
 * is several times what the scatter is off by. */
static const double GOOD = 0.02, GOOD_ANGLES = 0.1;

static skg_status check(int64_t count, skg_material *const *materials, double low_kev, double high_kev) {
    if (!(low_kev < high_kev))
        return skg_fail(SKG_ERR_ARGUMENT, "scatter: photons from %g to %g keV: the range is empty", low_kev,
                        high_kev);
    SKG_TRY(skg_check_energy("scatter", low_kev));
    SKG_TRY(skg_check_energy("scatter", high_kev));
    for (int64_t m = 0; m < count; m++) {
        SKG_TRY(skg_scattering_check(materials[m]));
        if (!(materials[m]->density > 0))
            return skg_fail(SKG_ERR_MATERIAL, "%s: its density is not known; give one in g/cm3",
                            materials[m]->name);
    }
    return SKG_OK;
}

static skg_status allocate(int64_t count, double low_kev, double high_kev, skg_scatter_physics *p) {
    p->low_kev = low_kev, p->high_kev = high_kev;
    p->energies = (int64_t)ceil(log(high_kev / low_kev) / ENERGY_STEP) + 1;
    p->momentum_scale = MOMENTUM_SCALE;
    p->momentum_high = high_kev / SKG_HC_KEV_ANGSTROM;
    p->momenta = (int64_t)ceil(log1p(p->momentum_high / MOMENTUM_SCALE) / MOMENTUM_STEP) + 1;
    p->materials = count;
    skg_mixture **const by_energy[] = {&p->total, &p->compton, &p->rayleigh, &p->compton_shape,
                                       &p->rayleigh_shape};
    for (size_t i = 0; i < sizeof by_energy / sizeof *by_energy; i++)
        SKG_TRY(skg_alloc(p->energies, sizeof **by_energy[i], "scatter", by_energy[i]));
    SKG_TRY(skg_alloc(p->momenta, sizeof *p->incoherent, "scatter", &p->incoherent));
    SKG_TRY(skg_alloc(p->momenta, sizeof *p->coherent, "scatter", &p->coherent));
    return skg_alloc(count, sizeof *p->coefficients, "scatter", &p->coefficients);
}

/* Weights of the errors of each function. The error of the total is multiplied by the thickness of the object in mean free paths, and
 * Rayleigh scattering, a tenth of all, goes forward anyway. */
static const double IMPORTANCE[SKG_SCATTER_FUNCTIONS] = {4, 2, 1, 1, 0.3};

/* Rows in the search for coefficients. The energies count alike. A momentum transfer counts by its share of the shapes of the
 * first material, summed over some energies; all of them together count like the energies. Weights are of errors, so
 * the roots of these. scratch: [2][momenta] */
static void weigh(const skg_scatter_physics *p, const double *column, double *weight, double *scratch) {
    const double *table[2] = {column + skg_scatter_first_row(p, SKG_SCATTER_INCOHERENT),
                              column + skg_scatter_first_row(p, SKG_SCATTER_COHERENT)};
    double *shares = weight + skg_scatter_first_row(p, SKG_SCATTER_INCOHERENT);
    memset(shares, 0, (size_t)(2 * p->momenta) * sizeof *shares);
    for (int64_t e = 0; e < p->energies; e += EVERY) {
        const int64_t points = skg_shape_weights(p, skg_scatter_energy(p, e), scratch, scratch + p->momenta);
        for (int f = 0; f < 2; f++) {
            const double *own = scratch + f * p->momenta;
            double sum = 0;
            for (int64_t i = 0; i < points; i++) sum += own[i] * table[f][i];
            for (int64_t i = 0; i < points; i++)
                shares[f * p->momenta + i] += EVERY * own[i] * table[f][i] / sum;
        }
    }
    for (int f = 0; f < SKG_SCATTER_FUNCTIONS; f++)
        for (int64_t i = skg_scatter_first_row(p, f); i < skg_scatter_first_row(p, f + 1); i++)
            weight[i] = IMPORTANCE[f] * (f < SKG_SCATTER_INCOHERENT ? 1 : sqrt(weight[i]));
}

static void store(const skg_scatter_physics *p, double (*basis)[SKG_SCATTER_RANK]) {
    skg_mixture *const table[] = {p->total, p->compton, p->rayleigh, p->incoherent, p->coherent};
    for (int f = 0; f < SKG_SCATTER_FUNCTIONS; f++) {
        const int64_t first = skg_scatter_first_row(p, f), rows = skg_scatter_first_row(p, f + 1) - first;
        for (int64_t i = 0; i < rows; i++)
            for (int k = 0; k < SKG_SCATTER_RANK; k++) table[f][i][k] = (float)basis[first + i][k];
    }
}

/* scratch: [2][momenta] */
static void integrate_shapes(const skg_scatter_physics *p, double *scratch) {
    skg_mixture *const table[2] = {p->incoherent, p->coherent}, *const shape[2] = {p->compton_shape,
                                                                                   p->rayleigh_shape};
    for (int64_t e = 0; e < p->energies; e++) {
        const int64_t points = skg_shape_weights(p, skg_scatter_energy(p, e), scratch, scratch + p->momenta);
        for (int f = 0; f < 2; f++) {
            double sum[SKG_SCATTER_RANK] = {0};
            for (int64_t i = 0; i < points; i++)
                for (int k = 0; k < SKG_SCATTER_RANK; k++)
                    sum[k] += scratch[f * p->momenta + i] * (double)table[f][i][k];
            for (int k = 0; k < SKG_SCATTER_RANK; k++) shape[f][e][k] = (float)sum[k];
        }
    }
}

static double mix(const double coefficient[SKG_SCATTER_RANK], const skg_mixture of) {
    double sum = 0;
    for (int k = 0; k < SKG_SCATTER_RANK; k++) sum += coefficient[k] * (double)of[k];
    return sum;
}

static double energies_error(const skg_scatter_physics *p, int64_t material, const double *column) {
    skg_mixture *const table[] = {p->total, p->compton, p->rayleigh};
    double worst = 0;
    for (int f = 0; f < SKG_SCATTER_INCOHERENT; f++)
        for (int64_t e = 0; e < p->energies; e++) {
            const double value = column[skg_scatter_first_row(p, f) + e];
            worst = fmax(worst, fabs(mix(p->coefficients[material], table[f][e]) / value - 1));
        }
    return worst;
}

/* The greatest integral of the absolute difference of a material's shapes over the integral, at one energy.
 *
 * weights   [2][momenta]
 * wrong     [2][momenta] the absolute differences
 * exact     [2][momenta] */
static double shape_error(const skg_scatter_physics *p, int64_t points, const double *weights,
                          const double *wrong, const double *exact) {
    double worst = 0;
    for (int f = 0; f < 2; f++) {
        double sum = 0, whole = 0;
        for (int64_t i = f * p->momenta; i < f * p->momenta + points; i++) {
            sum += weights[i] * wrong[i];
            whole += weights[i] * exact[i];
        }
        worst = fmax(worst, sum / whole);
    }
    return worst;
}

static skg_status shapes_error(const skg_scatter_physics *p, const double *columns, double *error) {
    skg_mixture *const table[2] = {p->incoherent, p->coherent};
    const int64_t rows = skg_scatter_first_row(p, SKG_SCATTER_FUNCTIONS), both = 2 * p->momenta;
    const double *exact = columns + skg_scatter_first_row(p, SKG_SCATTER_INCOHERENT);
    double *weights = NULL, *wrong = NULL;
    SKG_TRY(skg_alloc((1 + p->materials) * both, sizeof *weights, "scatter", &weights));
    wrong = weights + both;
    for (int64_t m = 0; m < p->materials; m++)
        for (int64_t i = 0; i < both; i++)
            wrong[m * both + i] =
                fabs(mix(p->coefficients[m], table[i / p->momenta][i % p->momenta]) - exact[m * rows + i]);
    for (int64_t e = 0; e < p->energies; e += EVERY) {
        const int64_t points = skg_shape_weights(p, skg_scatter_energy(p, e), weights, weights + p->momenta);
        for (int64_t m = 0; m < p->materials; m++)
            *error = fmax(*error, shape_error(p, points, weights, wrong + m * both, exact + m * rows));
    }
    skg_free(&weights);
    return SKG_OK;
}

static skg_status fill(int64_t count, skg_material *const *materials, const skg_emitters *emitters,
                       skg_scatter_physics *p) {
    const int64_t rows = skg_scatter_first_row(p, SKG_SCATTER_FUNCTIONS);
    double *columns = NULL, *weight = NULL, *scratch = NULL, (*basis)[SKG_SCATTER_RANK] = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_scatter_columns(count, materials, p, &columns));
    SKG_TRY_CLEANUP(skg_alloc(rows, sizeof *weight, "scatter", &weight));
    SKG_TRY_CLEANUP(skg_alloc(2 * p->momenta, sizeof *scratch, "scatter", &scratch));
    SKG_TRY_CLEANUP(skg_alloc(rows, sizeof *basis, "scatter", &basis));
    if (count > 0) weigh(p, columns, weight, scratch);
    for (p->rank = SKG_SCATTER_FOUR;; p->rank += SKG_SCATTER_FOUR) {
        SKG_TRY_CLEANUP(skg_reduce(p->rank, count, rows, weight, columns, p->coefficients, basis));
        store(p, basis);
        integrate_shapes(p, scratch);
        p->attenuation_error = ROUNDING_OF_FLOATS;
        for (int64_t m = 0; m < count; m++)
            p->attenuation_error = fmax(p->attenuation_error, energies_error(p, m, columns + m * rows));
        p->error = p->attenuation_error;
        SKG_TRY_CLEANUP(shapes_error(p, columns, &p->error));
        if (emitters) SKG_TRY_CLEANUP(skg_emission_make(count, materials, emitters, p));
        p->error = fmax(p->error, p->emission_error);
        if (p->rank == SKG_SCATTER_RANK ||
            (p->attenuation_error <= GOOD && p->emission_error <= GOOD && p->error <= GOOD_ANGLES))
            break;
    }
cleanup:
    skg_free(&columns);
    skg_free(&weight);
    skg_free(&scratch);
    skg_free(&basis);
    return status;
}

skg_status skg_scatter_physics_make(int64_t count, skg_material *const *materials,
                                    const skg_emitters *emitters, double low_kev, double high_kev,
                                    skg_scatter_physics *physics) {
    SKG_PLAIN;
    *physics = (skg_scatter_physics){0};
    SKG_TRY(check(count, materials, low_kev, high_kev));
    skg_status status = allocate(count, low_kev, high_kev, physics);
    if (status == SKG_OK) status = fill(count, materials, emitters, physics);
    if (status != SKG_OK) skg_scatter_physics_free(physics);
    return status;
}
