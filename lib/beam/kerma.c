/* Air kerma and half-value layers. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "material/material.h"

#include <math.h>

/* Dry air near sea level by mass (NIST). */
static const skg_mass_fraction air[4] = {{6, 0.000124}, {7, 0.755268}, {8, 0.231781}, {18, 0.012827}};

/* The cross section in cm2 for the energy that a photon transfers to a free electron (Klein and Nishina): the whole
 * cross section less the share of the energy that the scattered photon keeps. */
static double klein_nishina_transfer(double energy_kev) {
    const double radius = 2.8179403262e-13; /* classical radius of the electron, cm (CODATA 2018) */
    const double rest_kev = 510.99895;      /* rest energy of the electron (CODATA 2018) */
    double a = energy_kev / rest_kev, b = 1 + 2 * a, l = log1p(2 * a);
    double all = 2 * ((1 + a) / (a * a) * (2 * (1 + a) / b - l / a) + l / (2 * a) - (1 + 3 * a) / (b * b));
    double kept = l / (a * a * a) + 2 * (1 + a) * (2 * a * a - 2 * a - 1) / (a * a * b * b) +
                  8 * a * a / (3 * b * b * b);
    return SKG_PI * radius * radius * (all - kept);
}

double skg_air_kerma(double energy_kev) {
    const double avogadro = 6.02214076e23, joule_per_kev = 1.602176634e-16; /* exact by the SI of 2019 */
    double sections[SKG_PROCESSES], electrons = 0;                          /* electrons per g */
    skg_mixed_sections(4, air, energy_kev, sections);
    for (int i = 0; i < 4; i++)
        electrons += air[i].fraction * air[i].z / skg_elements[air[i].z].weight * avogadro;
    double pairs = energy_kev > SKG_PAIR_THRESHOLD_KEV
                       ? sections[SKG_PAIR] * (1 - SKG_PAIR_THRESHOLD_KEV / energy_kev)
                       : 0;
    double transfer =
        sections[SKG_PHOTO] + electrons * klein_nishina_transfer(energy_kev) + pairs; /* cm2/g */
    /* 100 mm2 in a cm2, 1000 g in a kg, 1e6 uGy in a Gy. */
    return 100 * energy_kev * joule_per_kev * transfer * 1000 * 1e6;
}

double skg_spectrum_kerma(const skg_spectrum *spectrum) {
    double sum = 0;
    for (int64_t i = 0; i < spectrum->count; i++)
        sum += spectrum->photons[i] * skg_air_kerma(spectrum->energy_kev[i]);
    return sum;
}

typedef struct {
    int64_t count;
    double *kerma;  /* [count] uGy of the photons of each energy */
    double *per_mm; /* [count] mu of the layer */
} layer;

static double behind(const layer *l, double mm) {
    double sum = 0;
    for (int64_t i = 0; i < l->count; i++) sum += l->kerma[i] * exp(-l->per_mm[i] * mm);
    return sum;
}

/* The thickness in mm that transmits `fraction` of the kerma. The curve falls and is convex, so Newton's steps from 0
 * approach it from one side; ten suffice, and 200 are a limit that is not reached. They end when a step changes only
 * the last digits. */
static double thickness(const layer *l, double fraction) {
    double wanted = fraction * behind(l, 0), mm = 0;
    for (int step = 0; step < 200; step++) {
        double slope = 0, value = 0;
        for (int64_t i = 0; i < l->count; i++) {
            double left = l->kerma[i] * exp(-l->per_mm[i] * mm);
            value += left;
            slope += left * l->per_mm[i];
        }
        double move = (value - wanted) / slope;
        mm += move;
        if (!(fabs(move) > 1e-13 * mm)) break;
    }
    return mm;
}

skg_status skg_half_value_layers(const skg_spectrum *spectrum, const skg_material *material, double *first,
                                 double *second) {
    layer l = {.count = spectrum->count};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(l.count, sizeof(double), "half-value layer", &l.kerma));
    SKG_TRY_CLEANUP(skg_alloc(l.count, sizeof(double), "half-value layer", &l.per_mm));
    for (int64_t i = 0; i < l.count; i++) {
        double per_cm = 0;
        SKG_TRY_CLEANUP(skg_material_attenuation_get(material, spectrum->energy_kev[i], &per_cm));
        l.per_mm[i] = per_cm / 10;
        l.kerma[i] = spectrum->photons[i] * skg_air_kerma(spectrum->energy_kev[i]);
    }
    *first = thickness(&l, 0.5);
    *second = thickness(&l, 0.25) - *first;
cleanup:
    skg_free(&l.kerma);
    skg_free(&l.per_mm);
    return status;
}
