/* Single interactions as the kernel samples them, against quadrature of the cross sections: angles, energies, and the energy that is
 * neither lost nor made. */
#include "material/scattering.h"
#include "sample.h"
#include "subject.h"
#include "suite.h"
#include "support/named.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* Ranges of the angle, even in its root; steps of the quadrature in each. */
enum { RANGES = 24, STEPS = 400, PHOTONS = SAMPLE_PHOTONS };

/* Per interaction: photons by range of the angle, those of Compton scattering, keV that fly on. */
typedef struct {
    double range[RANGES], photons, compton, kev;
} tally;

static tally expected(const char *name, double kev) {
    tally t = {.photons = 0};
    double share[2][RANGES] = {{0}}, sums[2] = {0}, left[2] = {0};
    skg_material *material = named(name);
    skg_coefficients c;
    skg_coefficients_init(&c);
    ck_skg(skg_material_coefficients_get(material, kev, &c));
    for (int i = 0; i < RANGES * STEPS; i++) {
        const double root = (i + 0.5) / (RANGES * STEPS), theta = PI * root * root, cosine = cos(theta);
        const double sr = 2 * PI * sin(theta) * 2 * PI * root / (RANGES * STEPS),
                     ratio = 1 / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
        double coherent = 0, incoherent = 0;
        ck_skg(skg_scattering_factors(material, kev / SKG_HC_KEV_ANGSTROM * sin(theta / 2), &coherent,
                                      &incoherent));
        /* Thomson, and Klein and Nishina 1929 */
        const double each[2] = {sr * (1 + cosine * cosine) / 2 * coherent,
                                sr * ratio * ratio * (ratio + 1 / ratio - 1 + cosine * cosine) / 2 *
                                    incoherent};
        for (int k = 0; k < 2; k++) {
            share[k][i / STEPS] += each[k], sums[k] += each[k];
            left[k] += each[k] * (k ? ratio : 1) * kev;
        }
    }
    const double chance[2] = {c.rayleigh / c.total, c.compton / c.total};
    for (int k = 0; k < 2; k++) {
        for (int r = 0; r < RANGES; r++) t.range[r] += chance[k] * share[k][r] / sums[k];
        t.photons += chance[k];
        t.kev += chance[k] * left[k] / sums[k];
    }
    t.compton = chance[1];
    skg_material_release(&material);
    return t;
}

static tally found(const float *out) {
    tally t = {.photons = 0};
    for (int i = 0; i < PHOTONS; i++) {
        const double weight = (double)out[4 * i] / PHOTONS,
                     cosine = fmin(fmax((double)out[4 * i + 1], -1), 1);
        const int range = (int)(sqrt(acos(cosine) / PI) * RANGES);
        t.range[range < RANGES ? range : RANGES - 1] += weight;
        t.photons += weight;
        t.compton += weight * (double)out[4 * i + 3];
        t.kev += weight * (double)out[4 * i + 2];
    }
    return t;
}

/* Of one material at one energy; at: a place of it, in shares of the box. */
static void compare(const subject *s, const double at[3], const char *name, double kev) {
    static float out[4 * PHOTONS];
    ck_skg(sample_run(run_context, s->plan, at, kev, out));
    const tally truth = expected(name, kev), own = found(out);
    double worst = 0;
    for (int r = 0; r < RANGES; r++)
        worst = fmax(worst, fabs(own.range[r] - truth.range[r]) / (truth.range[r] + 1e-3));
    printf("%s, %g keV: photons %+.1e, of Compton %+.1e, energy %+.1e, worst range of angles %.1e\n", name,
           kev, own.photons / truth.photons - 1, own.compton / truth.compton - 1, own.kev / truth.kev - 1,
           worst);
    fflush(stdout); /* before an assertion ends the process */
    /* A weight of 1 leaves so much for the photons that fly on; the rest of the energy is absorbed. Linear tables of 2e-4 between
     * their points (interactions.h) and single precision allow 1e-4 for sums. */
    ck_assert_double_eq_tol(own.photons / truth.photons, 1, 1e-4);
    ck_assert_double_eq_tol(own.kev / truth.kev, 1, 1e-4);
    /* The process is drawn: 4e-4 is a standard error of a million draws. */
    ck_assert_double_eq_tol(own.compton / truth.compton, 1, 2e-3);
    /* The tables again, and the rounding of cosines near 1. */
    ck_assert_double_le(worst, 2e-3);
}

START_TEST(interactions_are_those_of_the_cross_sections) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    static const double energies[] = {60, 33, 21}, water[3] = {0.1, 0.1, 0.5},
                        bone[3] = {50 / 80.0, 35 / 60.0, 0.5};
    for (int e = 0; e < 3; e++) {
        compare(&s, water, "Water, Liquid", energies[e]);
        compare(&s, bone, "Bone, Cortical (ICRU-44)", energies[e]);
    }
    pictures_free(&p);
    subject_close(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, interactions_are_those_of_the_cross_sections);
}

SKG_SUITE_MAIN("scatter/sampling", add_tests)
