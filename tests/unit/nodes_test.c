/* Spectral compression against the sum over all bins. */
#include "suite.h"

#include "plan/nodes.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>
#include <stdio.h>
#include <time.h>

enum { MOST = 512, MATERIALS = 12 };

typedef struct {
    skg_polychromatic beam;
    double mu[MATERIALS * MOST], shares[2 * MOST], low[MATERIALS], high[MATERIALS];
} subject;

static const char *const tissues[] = {"Tissue, Soft (ICRU-44)", "Bone, Cortical (ICRU-44)",
                                      "Adipose Tissue (ICRU-44)", "Lung Tissue (ICRU-44)", "I", "Fe"};
static const double thick[] = {250, 50, 80, 150, 0.6, 1.5};

/* A beam of tungsten through 2.5 mm of aluminium; each bin counts its energy, and energy squared in a second set. */
static void take(subject *s, double kvp, int materials, const char *const *names, const double *most,
                 int sets) {
    skg_tube tube;
    skg_spectrum *spectrum = NULL;
    skg_material *aluminium = NULL;
    double sums[2] = {0};
    int64_t bins = 0;
    ck_skg(skg_material_element(13, &aluminium));
    const skg_filter filter = {aluminium, 2.5};
    skg_tube_init(&tube);
    tube.kvp = kvp, tube.filter_count = 1, tube.filters = &filter;
    ck_skg(skg_spectrum_tube(&tube, &spectrum));
    ck_skg(skg_spectrum_size(spectrum, &bins));
    ck_assert_int_le(bins, MOST);
    for (int64_t b = 0; b < bins; b++) {
        double kev = 0, photons = 0;
        ck_skg(skg_spectrum_bin(spectrum, b, &kev, &photons));
        for (int k = 0; k < sets; k++) sums[k] += s->shares[b * sets + k] = photons * (k ? kev * kev : kev);
    }
    for (int64_t b = 0; b < bins * sets; b++) s->shares[b] /= sums[b % sets];
    for (int m = 0; m < materials; m++) {
        skg_material *material = NULL;
        ck_skg(skg_material_named(names[m], &material));
        for (int64_t b = 0; b < bins; b++) {
            double kev = 0, photons = 0;
            ck_skg(skg_spectrum_bin(spectrum, b, &kev, &photons));
            ck_skg(skg_material_attenuation(material, kev, &s->mu[m * bins + b]));
            s->mu[m * bins + b] *= 0.1;
        }
        s->low[m] = 0, s->high[m] = most[m];
        skg_material_release(&material);
    }
    s->beam = (skg_polychromatic){(int32_t)bins, materials, sets, 0, s->mu, s->shares, s->low, s->high};
    skg_spectrum_release(&spectrum);
    skg_material_release(&aluminium);
}

START_TEST(explore) {
    static subject s;
    static const double tols[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
    for (int sets = 1; sets <= 2; sets++)
    for (int n = 4; n <= 6; n += 2)
        for (int t = 0; t < 6; t++) {
            skg_compression c;
            take(&s, 150, n, tissues, thick, sets);
            clock_t a = clock();
            ck_skg(skg_nodes_find(&s.beam, s.mu, tols[t], 0, NULL, &c));
            printf("%d sets %d materials %d bins tol %g: %d nodes bound %g on %ld, %.3f s\n", sets, n, s.beam.bins, tols[t], c.nodes.count, c.bound,
                   (long)c.verified, (double)(clock() - a) / CLOCKS_PER_SEC);
            skg_nodes_release(&c.nodes);
        }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_set_timeout(tests, 300);
    tcase_add_test(tests, explore); }
SKG_SUITE_MAIN("nodes", add_tests)
