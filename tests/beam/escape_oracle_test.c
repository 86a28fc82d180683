/* K fluorescence that leaves scintillators, against a Monte Carlo that follows single photons with the cross sections, jumps,
 * yields and lines of xraylib. */
#include "suite.h"
#include "support/named.h"

#include <skiagraph/beam.h>

#include <math.h>
#include <stdlib.h>
#include <xraylib.h>

enum { PHOTONS = 50000, ELEMENTS = 2, LINES = 6 };
static const int lines[LINES] = {KL3_LINE, KL2_LINE, KM3_LINE, KM2_LINE, KN3_LINE, KN2_LINE};

typedef struct {
    const char *name;
    double mm, g_cm3;
    int z[ELEMENTS]; /* those whose K shells are hit */
} layer;

static const layer layers[] = {{"CsI", 0.6, 4.51, {53, 55}},
                               {"Gd2O2S", 0.2, 7.44, {64, 0}},
                               {"Se", 0.2, 4.5, {34, 0}},
                               {"CdTe", 1, 6.2, {48, 52}}};

static uint64_t state = 88172645463325252u;

static double uniform(void) { /* above 0, below 1; xorshift */
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return ((double)(state >> 11) + 0.5) * 0x1p-53;
}

static double fraction(const char *name, int z) {
    struct compoundData *compound = CompoundParser(name, NULL);
    double found = 0;
    for (int i = 0; i < compound->nElements; i++)
        if (compound->Elements[i] == z) found = compound->massFractions[i];
    FreeCompoundData(compound);
    return found;
}

/* The line that follows an interaction at an energy; 0: none. */
static double follow(const layer *l, const double *fractions, double kev, double cm2_g) {
    double draw = uniform();
    for (int e = 0; e < ELEMENTS && l->z[e]; e++) {
        const int z = l->z[e];
        if (!(kev > EdgeEnergy(z, K_SHELL, NULL))) continue;
        const double share = fractions[e] * CS_Photo(z, kev, NULL) * (1 - 1 / JumpFactor(z, K_SHELL, NULL)) /
                             cm2_g * FluorYield(z, K_SHELL, NULL);
        for (int k = 0; k < LINES; k++) {
            const double here = share * RadRate(z, lines[k], NULL);
            if (draw < here) return LineEnergy(z, lines[k], NULL);
            draw -= here;
        }
    }
    return 0;
}

/* Energy that a photon which interacts leaves in the layer, keV. */
static double deposit(const layer *l, const double *fractions, double energy, double oblique, double cm2_g) {
    double kev = energy;
    const double mu = cm2_g * l->g_cm3 / 10 * oblique;
    double z = -log1p(uniform() * expm1(-mu * l->mm)) / mu;
    for (;;) {
        kev = follow(l, fractions, kev, cm2_g);
        if (kev == 0) return energy;
        cm2_g = CS_Total_CP(l->name, kev, NULL);
        z += (2 * uniform() - 1) * -log(uniform()) / (cm2_g * l->g_cm3 / 10);
        if (z < 0 || z > l->mm) return energy - kev;
    }
}

START_TEST(single_photons) {
    const layer *l = &layers[_i];
    static const double energies[] = {15, 28, 34, 37, 45, 52, 60, 80, 100};
    skg_material *named_one = named(l->name), *material = NULL;
    skg_response *plain = NULL, *escaping = NULL;
    double fractions[ELEMENTS];
    for (int e = 0; e < ELEMENTS; e++) fractions[e] = l->z[e] ? fraction(l->name, l->z[e]) : 0;
    ck_skg(skg_material_create_at_density(named_one, l->g_cm3, &material));
    ck_skg(skg_response_create_scintillator(material, l->mm, 1, &plain));
    ck_skg(skg_response_create_escaping(plain, &escaping));
    for (size_t i = 0; i < sizeof energies / sizeof *energies; i++)
        for (double oblique = 1; oblique < 1.6; oblique += 0.5) {
            double recorded = 0, efficiency = 0, swank = 0, one = 0, two = 0;
            const double cm2_g = CS_Total_CP(l->name, energies[i], NULL);
            ck_skg(skg_response_get(escaping, energies[i], oblique, &recorded, &efficiency));
            ck_skg(skg_response_swank_get(escaping, energies[i], oblique, &swank));
            for (int k = 0; k < PHOTONS; k++) {
                const double left = deposit(l, fractions, energies[i], oblique, cm2_g);
                one += left / PHOTONS, two += left * left / PHOTONS;
            }
            const double error = sqrt(fmax(two - one * one, 0) / PHOTONS), mean = recorded / efficiency;
            if (getenv("SKG_LIST"))
                printf(
                    "%s %g keV, %g: %.4f of the energy, Monte Carlo %.4f +- %.4f; Swank factor %.4f, %.4f\n",
                    l->name, energies[i], oblique, mean / energies[i], one / energies[i], error / energies[i],
                    swank, one * one / two);
            /* Four standard errors, and 2 % of the escape for jumps, which differ by this between tables. */
            const double bar = 4 * error + 0.02 * (energies[i] - one) + 1e-9;
            ck_assert_msg(fabs(mean - one) <= bar, "%s, %g keV: %g instead of %g +- %g keV", l->name,
                          energies[i], mean, one, bar);
            ck_assert_double_eq_tol(swank, one * one / two, 4 * error / one + 0.02 * (1 - swank) + 1e-9);
        }
    skg_response_release(&plain);
    skg_response_release(&escaping);
    skg_material_release(&material);
    skg_material_release(&named_one);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, single_photons, 0, sizeof layers / sizeof *layers);
}

SKG_SUITE_MAIN("escape_oracle", add_tests)
