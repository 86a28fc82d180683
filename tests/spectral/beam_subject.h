/* Beams through materials, as tests of planes and nodes need them. */
#ifndef SKG_TESTS_BEAM_SUBJECT_H
#define SKG_TESTS_BEAM_SUBJECT_H

#include "suite.h"

#include "spectral/verification.h"

#include <skiagraph/skiagraph.h>

enum { SUBJECT_BINS = 200, SUBJECT_MATERIALS = 12, SUBJECT_SETS = 4 };

typedef struct {
    skg_polychromatic beam;
    double mu[SUBJECT_MATERIALS * SUBJECT_BINS], shares[SUBJECT_SETS * SUBJECT_BINS];
    double low[SUBJECT_MATERIALS], high[SUBJECT_MATERIALS];
} subject;

/* Tungsten through 2.5 mm of aluminium, every keV up to kvp. Set k counts energy to the power of k + 1. */
static void take_subject(subject *s, double kvp, int materials, const char *const *names, const double *most,
                         int sets) {
    skg_tube tube;
    skg_spectrum *spectrum = NULL;
    skg_material *aluminium = NULL;
    double sums[SUBJECT_SETS] = {0}, kev[SUBJECT_BINS];
    int64_t bins = 0;
    ck_skg(skg_material_create_element(13, &aluminium));
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 2.5};
    skg_tube_init(&tube);
    tube.kvp = kvp, tube.filter_count = 1, tube.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&tube, &spectrum));
    ck_skg(skg_spectrum_bin_count(spectrum, &bins));
    ck_assert_int_le(bins, SUBJECT_BINS);
    for (int64_t b = 0; b < bins; b++) {
        double worth = 0;
        ck_skg(skg_spectrum_bin_get(spectrum, b, &kev[b], &worth));
        for (int k = 0; k < sets; k++) sums[k] += s->shares[b * sets + k] = worth *= kev[b];
    }
    for (int64_t k = 0; k < bins * sets; k++) s->shares[k] /= sums[k % sets];
    for (int m = 0; m < materials; m++) {
        skg_material *material = NULL;
        ck_skg(skg_material_create_named(names[m], &material));
        for (int64_t b = 0; b < bins; b++) {
            ck_skg(skg_material_attenuation_get(material, kev[b], &s->mu[m * bins + b]));
            s->mu[m * bins + b] *= 0.1; /* 1/cm to 1/mm */
        }
        s->low[m] = 0, s->high[m] = most[m];
        skg_material_release(&material);
    }
    s->beam = (skg_polychromatic){(int32_t)bins, materials,        sets, 0, s->mu, s->shares, s->low,
                                  s->high,       SKG_RELATIVE_FROM};
    skg_spectrum_release(&spectrum);
    skg_material_release(&aluminium);
}

/* Evenly from 0 to below 1 (Knuth's MMIX generator, upper bits). */
static inline double next_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

#endif
