/* Interactions of photons in a material: cross sections, energy transfer, angles of scattering. */
#include "dose/matter.h"

#include "core/maths.h"
#include "material/material.h"
#include "material/scattering.h"

/* The value of a table for the material by itself. */
static double value_of(const skg_dose_matter *m, const skg_mixture row) {
    double sum = 0;
    for (int k = 0; k < m->physics.rank; k++) sum += m->physics.coefficients[0][k] * (double)row[k];
    return sum;
}

static double value_at(const skg_dose_matter *m, const skg_mixture *table, skg_dose_place place) {
    const double here = value_of(m, table[place.row]), next = value_of(m, table[place.row + 1]);
    return fmax(here + place.share * (next - here), 0);
}

static double number_at(const double *table, skg_dose_place place) {
    return table[place.row] + place.share * (table[place.row + 1] - table[place.row]);
}

static skg_dose_place place_in(int64_t rows, double at) {
    const double within = fmin(fmax(at, 0), (double)(rows - 1));
    const int64_t row = within < (double)(rows - 2) ? (int64_t)within : rows - 2;
    return (skg_dose_place){row, within - (double)row};
}

skg_dose_place skg_dose_place_of(const skg_dose_matter *m, double kev) {
    const skg_scatter_physics *p = &m->physics;
    return place_in(p->energies,
                    log(kev / p->low_kev) / log(p->high_kev / p->low_kev) * (double)(p->energies - 1));
}

static skg_dose_place place_of_momentum(const skg_dose_matter *m, double x) {
    const skg_scatter_physics *p = &m->physics;
    return place_in(p->momenta, log1p(x / p->momentum_scale) / log1p(p->momentum_high / p->momentum_scale) *
                                    (double)(p->momenta - 1));
}

static double momentum_of(double kev, double cosine) {
    return kev / SKG_HC_KEV_ANGSTROM * sqrt(fmax(0.5 * (1 - cosine), 0));
}

/* The energy that Compton scattering leaves a photon. */
static double left_of(double kev, double cosine) {
    return kev / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
}

/* --- tables */

/* The mean energy of an electron that Compton scattering sets free. weights: [2][momenta] workspace */
static double electron_of(const skg_dose_matter *m, double kev, double *weights) {
    const skg_scatter_physics *p = &m->physics;
    const double back = kev / SKG_HC_KEV_ANGSTROM;
    const int64_t points = skg_shape_weights(p, kev, weights, weights + p->momenta);
    double sum = 0, all = 0;
    for (int64_t i = 0; i < points; i++) {
        const double x = fmin(skg_scatter_momentum(p, i), back),
                     own = weights[i] * value_of(m, p->incoherent[i]);
        all += own;
        sum += own * (kev - left_of(kev, 1 - 2 * (x / back) * (x / back)));
    }
    return all > 0 ? sum / all : 0;
}

static double mean_line(const skg_emitter *e) {
    double sum = 0, before = 0;
    for (int l = 0; l < SKG_SCATTER_LINES; l++) {
        sum += ((double)e->lines[l][0] - before) * (double)e->lines[l][1];
        before = (double)e->lines[l][0];
    }
    return sum;
}

static void fill_transfer(skg_dose_matter *m, double *weights) {
    const skg_scatter_physics *p = &m->physics;
    for (int64_t i = 0; i < p->energies; i++) {
        const double kev = skg_scatter_energy(p, i), compton = value_of(m, p->compton[i]);
        const double absorbed = fmax(value_of(m, p->total[i]) - compton - value_of(m, p->rayleigh[i]), 0);
        m->transfer[i] = absorbed * kev + compton * electron_of(m, kev, weights);
        for (int64_t s = 0; s < p->shells; s++)
            m->transfer[i] -= value_of(m, p->emission[i * p->shells + s]) * mean_line(&m->emitters.of[s]);
    }
}

static void fill_coherent(skg_dose_matter *m) {
    const skg_scatter_physics *p = &m->physics;
    for (int64_t i = 1; i < p->momenta; i++) {
        const double before = skg_scatter_momentum(p, i - 1), x = skg_scatter_momentum(p, i);
        m->coherent[i] =
            m->coherent[i - 1] +
            0.5 * (value_of(m, p->coherent[i - 1]) + value_of(m, p->coherent[i])) * (x * x - before * before);
    }
}

skg_status skg_dose_matter_make(skg_material *material, int32_t fluorescence, double high_kev,
                                skg_dose_matter *m) {
    double *weights = NULL;
    *m = (skg_dose_matter){.material = skg_material_is_void(material) ? NULL : material};
    if (!m->material) return SKG_OK;
    SKG_TRY(skg_emitters_find(1, &material, fluorescence, SKG_DOSE_LOWEST_KEV, high_kev, &m->emitters));
    SKG_TRY(skg_scatter_physics_make(1, &material, &m->emitters, SKG_DOSE_LOWEST_KEV,
                                     fmax(high_kev, 1.01 * SKG_DOSE_LOWEST_KEV), &m->physics));
    SKG_TRY(skg_alloc(m->physics.energies, sizeof *m->transfer, "dose", &m->transfer));
    SKG_TRY(skg_alloc(m->physics.momenta, sizeof *m->coherent, "dose", &m->coherent));
    SKG_TRY(skg_alloc(2 * m->physics.momenta, sizeof *weights, "dose", &weights));
    fill_transfer(m, weights);
    fill_coherent(m);
    skg_free(&weights);
    return SKG_OK;
}

void skg_dose_matter_free(skg_dose_matter *m) {
    skg_emitters_free(&m->emitters);
    skg_scatter_physics_free(&m->physics);
    skg_free(&m->transfer);
    skg_free(&m->coherent);
}

/* --- what a photon meets */

double skg_dose_total(const skg_dose_matter *m, skg_dose_place place) {
    return value_at(m, (const skg_mixture *)m->physics.total, place);
}

double skg_dose_transfer(const skg_dose_matter *m, skg_dose_place place) {
    return number_at(m->transfer, place);
}

double skg_dose_emitted(const skg_dose_matter *m, skg_dose_place place, int64_t shell) {
    const skg_scatter_physics *p = &m->physics;
    const double here = value_of(m, p->emission[place.row * p->shells + shell]),
                 next = value_of(m, p->emission[(place.row + 1) * p->shells + shell]);
    return fmax(here + place.share * (next - here), 0);
}

skg_dose_meeting skg_dose_meet(const skg_dose_matter *m, double kev) {
    const skg_scatter_physics *p = &m->physics;
    const skg_dose_place place = skg_dose_place_of(m, kev);
    skg_dose_meeting found = {
        .total = value_at(m, (const skg_mixture *)p->total, place),
        .compton = value_at(m, (const skg_mixture *)p->compton, place),
        .rayleigh = value_at(m, (const skg_mixture *)p->rayleigh, place),
        .transfer = number_at(m->transfer, place),
        .compton_shape = value_at(m, (const skg_mixture *)p->compton_shape, place),
        .rayleigh_shape = value_at(m, (const skg_mixture *)p->rayleigh_shape, place),
    };
    for (int64_t s = 0; s < p->shells; s++) found.emitted += skg_dose_emitted(m, place, s);
    return found;
}

void skg_dose_scattered(const skg_dose_matter *m, const skg_dose_meeting *i, double kev, double cosine,
                        double *compton, double *rayleigh, double *left) {
    const skg_scatter_physics *p = &m->physics;
    const skg_dose_place place = place_of_momentum(m, momentum_of(kev, cosine));
    const double per_compton = i->total * i->compton_shape, per_rayleigh = i->total * i->rayleigh_shape;
    *compton = per_compton > 0 ? i->compton * skg_klein_nishina(kev, cosine) *
                                     value_at(m, (const skg_mixture *)p->incoherent, place) / per_compton
                               : 0;
    *rayleigh = per_rayleigh > 0 ? i->rayleigh * skg_thomson(cosine) *
                                       value_at(m, (const skg_mixture *)p->coherent, place) / per_rayleigh
                                 : 0;
    *left = left_of(kev, cosine);
}

/* --- draws */

/* By rejection: the cross section of a free electron is greatest straight on, the scattering function straight back. */
double skg_dose_draw_compton(const skg_dose_matter *m, double kev, uint64_t *seed) {
    const skg_mixture *table = (const skg_mixture *)m->physics.incoherent;
    const double most = value_at(m, table, place_of_momentum(m, momentum_of(kev, -1)));
    for (;;) {
        const double cosine = 1 - 2 * skg_draw(seed);
        const double chance = skg_klein_nishina(kev, cosine) *
                              value_at(m, table, place_of_momentum(m, momentum_of(kev, cosine)));
        if (skg_draw(seed) * most <= chance) return cosine;
    }
}

/* By the integral of F^2 over the square of the momentum transfer, and rejection by Thomson's cross section. */
double skg_dose_draw_rayleigh(const skg_dose_matter *m, double kev, uint64_t *seed) {
    const skg_scatter_physics *p = &m->physics;
    const double back = kev / SKG_HC_KEV_ANGSTROM;
    const skg_dose_place end = place_of_momentum(m, back);
    const double all = number_at(m->coherent, end);
    for (;;) {
        const double wanted = skg_draw(seed) * all;
        int64_t low = 0, high = end.row + 1;
        while (high - low > 1) {
            const int64_t middle = (low + high) / 2;
            *(m->coherent[middle] <= wanted ? &low : &high) = middle;
        }
        const double step = m->coherent[low + 1] - m->coherent[low], x = skg_scatter_momentum(p, low),
                     next = skg_scatter_momentum(p, low + 1);
        const double square =
            x * x + (step > 0 ? (wanted - m->coherent[low]) / step : 0) * (next * next - x * x);
        const double cosine = 1 - 2 * fmin(square / (back * back), 1);
        if (skg_draw(seed) <= skg_thomson(cosine)) return cosine;
    }
}

double skg_dose_draw_line(const skg_dose_matter *m, int64_t shell, uint64_t *seed) {
    const skg_emitter *e = &m->emitters.of[shell];
    const double wanted = skg_draw(seed);
    int line = 0;
    while (line < SKG_SCATTER_LINES - 1 && (double)e->lines[line][0] <= wanted) line++;
    return (double)e->lines[line][1];
}
