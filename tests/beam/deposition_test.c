/* Energy that scattered photons leave in a scintillator, against photons that are followed one by one. */
#include "scatter/matter.h"
#include "suite.h"
#include "support/named.h"
#include "support/random.h"

#include <skiagraph/beam.h>

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846;

typedef struct {
    const char *name;
    double mm, packing, density; /* density: 0: the material's own */
} layer;

static const layer layers[] = {{"CsI", 0.6, 0.8, 4.51},
                               {"Gd2O2S", 0.2, 1, 7.44},
                               {"CdTe", 1, 1, 5.85},
                               {"Si", 0.5, 1, 2.33},
                               {"Se", 0.2, 1, 4.5}};
enum { LAYERS = sizeof layers / sizeof *layers };
static const double energies[] = {20, 40, 60, 80, 100, 150, 200, 300, 450};
enum { ENERGIES = sizeof energies / sizeof *energies, HISTORIES = 100000 };

static skg_response *response_of(const layer *l, int transports) {
    skg_material *material = named(l->name), *dense = NULL;
    skg_response *all = NULL, *transporting = NULL;
    ck_skg(skg_material_create_at_density(material, l->density, &dense));
    ck_skg(skg_response_create_scintillator(dense, l->mm, l->packing, &all));
    ck_skg(skg_response_create_transporting(all, &transporting));
    skg_material_release(&material);
    skg_material_release(&dense);
    skg_response_release(transports ? &all : &transporting);
    return transports ? transporting : all;
}

/* Energy that a photon leaves which first interacts at a depth, keV. */
static double follow(const matter *m, double mm, double kev, double depth, double way[3], uint64_t *seed) {
    double left = 0;
    for (;;) {
        const double kind = draw(seed, 0, 1), compton = matter_at_energy(m->compton, m, kev);
        if (kind >= compton + matter_at_energy(m->rayleigh, m, kev)) return left + kev;
        const double cosine = matter_draw(m, kev, kind < compton, seed);
        matter_turn(way, cosine, draw(seed, 0, 2 * PI));
        if (kind < compton) {
            const double after = kev * matter_ratio(kev, cosine);
            left += kev - after;
            kev = after;
        }
        if (kev < MATTER_LOWEST_KEV) return left + kev;
        depth -= way[2] * log1p(-draw(seed, 0, 1)) / matter_at_energy(m->total, m, kev);
        if (depth < 0 || depth > mm) return left;
    }
}

/* Mean over the energy, mean square over the square of the mean, and the errors of both. */
typedef struct {
    double mean, mean_sigma, square, square_sigma;
} moments;

static moments find_moments(const layer *l, double kev, double oblique, int histories) {
    static matter m;
    matter_make(l->name, l->density * l->packing, kev, &m);
    double sums[4] = {0};
    uint64_t seed = 7;
    const double per_mm = m.total[MATTER_ENERGIES] * oblique;
    for (int i = 0; i < histories; i++) {
        double way[3] = {sqrt(1 - 1 / (oblique * oblique)), 0, 1 / oblique};
        const double depth = -log1p(expm1(-per_mm * l->mm) * draw(&seed, 0, 1)) / per_mm;
        const double left = follow(&m, l->mm, kev, depth, way, &seed) / kev;
        double power = 1;
        for (int k = 0; k < 4; k++) sums[k] += (power *= left) / histories;
    }
    const double mean = sums[0];
    return (moments){mean, sqrt((sums[1] - mean * mean) / histories), sums[1] / (mean * mean),
                     sqrt((sums[3] - sums[1] * sums[1]) / histories) / (mean * mean)};
}

static void compare(const layer *l, const skg_response *r, double kev, double oblique) {
    const moments truth = find_moments(l, kev, oblique, HISTORIES);
    double recorded = 0, efficiency = 0, swank = 0;
    ck_skg(skg_response_get(r, kev, oblique, &recorded, &efficiency));
    ck_skg(skg_response_swank_get(r, kev, oblique, &swank));
    const double mean = recorded / (efficiency * kev);
    printf("%s, %g keV, oblique %g: %.4f, photons have %.4f +- %.4f; 1/Swank %.4f, %.4f +- %.4f\n", l->name,
           kev, oblique, mean, truth.mean, truth.mean_sigma, 1 / swank, truth.square, truth.square_sigma);
    fflush(stdout);
    /* Half a per cent for cells, directions and steps of energy, and four standard errors. */
    ck_assert_double_eq_tol(mean / truth.mean, 1, 5e-3 + 4 * truth.mean_sigma / truth.mean);
    ck_assert_double_eq_tol(1 / swank / truth.square, 1, 5e-3 + 6 * truth.square_sigma / truth.square);
}

START_TEST(layers_leave_what_single_photons_leave) {
    const layer *l = &layers[_i];
    skg_response *r = response_of(l, 1);
    for (int e = 0; e < ENERGIES; e++) compare(l, r, energies[e], 1);
    compare(l, r, 120, 2);
    skg_response_release(&r);
}
END_TEST

/* 600 um of CsI, as an analogue Monte Carlo of others has it, to 1 %. At 450 keV 2 % of the photons interact, and its figure, .521, is 3.6 % above
 * ours: .5022, and .5012 +- .0003 of 2e6 photons of the test below. So that one is held to 4 %. */
START_TEST(caesium_iodide) {
    static const double known[][2] = {{60, .987},  {80, .960},  {100, .932}, {150, .853},
                                      {200, .751}, {300, .605}, {450, .521}};
    skg_response *r = response_of(&layers[0], 1), *all = response_of(&layers[0], 0);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double recorded = 0, most = 0;
        ck_skg(skg_response_get(r, known[i][0], 1, &recorded, NULL));
        ck_skg(skg_response_get(all, known[i][0], 1, &most, NULL));
        printf("%g keV: %.4f, known %.3f\n", known[i][0], recorded / most, known[i][1]);
        fflush(stdout);
        /* as said above */
        ck_assert_double_eq_tol(recorded / most / known[i][1], 1, known[i][0] > 300 ? 0.04 : 0.01);
    }
    skg_response_release(&r);
    skg_response_release(&all);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, caesium_iodide);
    tcase_add_loop_test(tests, layers_leave_what_single_photons_leave, 0, LAYERS);
}

SKG_SUITE_MAIN("deposition", add_tests)
