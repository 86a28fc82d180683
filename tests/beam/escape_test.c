/* K fluorescence that leaves a scintillator, against closed forms. */
#include "beam/escape.h"
#include "material/material.h"
#include "suite.h"
#include "support/named.h"

#include <skiagraph/beam.h>

#include <float.h>
#include <math.h>

/* Cells of depth: what escape.c promises of shares that leave. */
static const double CELLS_ERROR = 1e-3;

static double photo(int32_t z, double kev) {
    double sections[SKG_PROCESSES];
    skg_element_sections(z, kev, sections);
    return sections[SKG_PHOTO];
}

static double total(const skg_material *material, double kev) { /* 1/mm */
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
    return per_cm / 10;
}

static const skg_shell_row *shell_of(int32_t z) {
    for (int32_t s = 0; s < skg_k_shell_count; s++)
        if (skg_k_shells[s].z == z) return &skg_k_shells[s];
    ck_abort_msg("element %d has no K shell", (int)z);
    return NULL;
}

/* The share of all interactions in selenium that leave a vacancy in the K shell. */
static double vacancies(const skg_material *selenium, double kev) {
    double sections[SKG_PROCESSES], density = 0;
    ck_skg(skg_material_density_get(selenium, &density));
    const double edge = 12.658; /* XCOM */
    const double jump = photo(34, edge) / photo(34, edge * (1 - 1e-9));
    skg_element_sections(34, kev, sections);
    return sections[SKG_PHOTO] * (1 - 1 / jump) / (total(selenium, kev) * 10 / density);
}

/* A layer without a back: of photons that arrive straight, the share (1 - m/mu ln(1 + mu/m)) / 2 of the fluorescence leaves
 * through the front, with the attenuation mu of the photons and m of the fluorescence (P. Axel, Rev. Sci. Instrum. 25 (1954)
 * 391). No line of selenium ionises its own K shell. */
START_TEST(thick_layer) {
    skg_material *selenium = named("Se");
    const skg_shell_row *shell = shell_of(34);
    static const double energies[] = {12.7, 15, 20, 30, 45};
    for (size_t i = 0; i < sizeof energies / sizeof *energies; i++)
        for (double oblique = 1; oblique < 2.5; oblique += 0.7) {
            const double kev = energies[i], mu = total(selenium, kev) * oblique;
            double energy = 0, square = 0, truth = 0, truth_square = 0;
            skg_escape *escape = NULL;
            /* exp(-40) of the photons and exp(-15) of the fluorescence reach the back. */
            const double back = fmax(40 / mu, 15 / total(selenium, shell->line_kev[2]));
            ck_skg(skg_escape_create(selenium, back, &escape));
            skg_escape_moments(escape, kev, total(selenium, kev), oblique, &energy, &square);
            for (int l = 0; l < SKG_K_LINES; l++) {
                const double m = total(selenium, shell->line_kev[l]);
                const double leaves = 0.5 * (1 - m / mu * log1p(mu / m)) * vacancies(selenium, kev) *
                                      shell->yield * shell->share[l];
                truth += leaves * shell->line_kev[l];
                truth_square += leaves * shell->line_kev[l] * shell->line_kev[l];
            }
            ck_assert_double_eq_tol(energy, truth, CELLS_ERROR * truth);
            ck_assert_double_eq_tol(square, truth_square, CELLS_ERROR * truth_square);
            skg_escape_release(&escape);
        }
    skg_material_release(&selenium);
}
END_TEST

/* All fluorescence leaves a layer that is much thinner than its own free path, which is 50 um. */
START_TEST(thin_layer) {
    skg_material *selenium = named("Se");
    const skg_shell_row *shell = shell_of(34);
    skg_response *layer = NULL, *escaping = NULL;
    double recorded = 0, efficiency = 0, swank = 0, left = 0, square = 0;
    const double kev = 20, share = vacancies(selenium, kev) * shell->yield;
    ck_skg(skg_response_create_scintillator(selenium, 1e-7, 1, &layer));
    ck_skg(skg_response_create_escaping(layer, &escaping));
    ck_skg(skg_response_get(escaping, kev, 1, &recorded, &efficiency));
    ck_skg(skg_response_swank_get(escaping, kev, 1, &swank));
    for (int l = 0; l < SKG_K_LINES; l++) {
        left += share * shell->share[l] * shell->line_kev[l];
        square += share * shell->share[l] * shell->line_kev[l] * shell->line_kev[l];
    }
    const double mean = kev - left;
    /* 1e-7 mm of 5e-2 mm is 2e-6 of a free path; its logarithm comes with it. */
    ck_assert_double_eq_tol(recorded / efficiency, mean, 1e-4 * mean);
    ck_assert_double_eq_tol(swank, mean * mean / (kev * kev - 2 * kev * left + square), 1e-4);
    skg_response_release(&layer);
    skg_response_release(&escaping);
    skg_material_release(&selenium);
}
END_TEST

/* Below the edges, and in elements of which the tables have no K shell, nothing changes. */
START_TEST(nothing_escapes) {
    static const struct {
        const char *material;
        double kev;
    } cases[] = {{"CsI", 33.1}, {"CsI", 20}, {"Gd2O2S", 50.2}, {"Se", 12.6}, {"CdTe", 26.7}, {"H2O", 60}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        skg_material *material = named(cases[i].material);
        skg_response *layer = NULL, *escaping = NULL;
        double one = 0, other = 0, swank = 0;
        ck_skg(skg_response_create_screen(material, 100, &layer));
        ck_skg(skg_response_create_escaping(layer, &escaping));
        ck_skg(skg_response_get(layer, cases[i].kev, 1.3, &one, NULL));
        ck_skg(skg_response_get(escaping, cases[i].kev, 1.3, &other, NULL));
        ck_skg(skg_response_swank_get(escaping, cases[i].kev, 1.3, &swank));
        ck_assert_double_eq_tol(other, one, 4 * DBL_EPSILON * one);
        ck_assert_double_eq_tol(swank, 1, 4 * DBL_EPSILON);
        skg_response_release(&layer);
        skg_response_release(&escaping);
        skg_material_release(&material);
    }
}
END_TEST

/* A measured DQE changes the Swank factor alone, and keeps it for oblique rays. */
START_TEST(measured_dqe) {
    static const double kev[3] = {20, 60, 100}, dqe[3] = {0.9, 0.6, 0.2}, high[3] = {0.9, 0.9, 0.2};
    skg_material *csi = named("CsI");
    skg_response *layer = NULL, *measured = NULL, *wrong = NULL;
    ck_skg(skg_response_create_scintillator(csi, 0.6, 0.8, &layer));
    ck_skg(skg_response_create_dqe(layer, 3, kev, dqe, &measured));
    for (double energy = 20; energy <= 100; energy += 10)
        for (double oblique = 1; oblique < 2; oblique += 0.4) {
            double recorded[2], efficiency[2], straight = 0, swank = 0;
            ck_skg(skg_response_get(layer, energy, oblique, &recorded[0], &efficiency[0]));
            ck_skg(skg_response_get(measured, energy, oblique, &recorded[1], &efficiency[1]));
            ck_assert_double_eq(recorded[0], recorded[1]);
            ck_assert_double_eq(efficiency[0], efficiency[1]);
            ck_skg(skg_response_get(layer, energy, 1, NULL, &straight));
            ck_skg(skg_response_swank_get(measured, energy, oblique, &swank));
            const double truth =
                energy < 60 ? 0.9 - 0.3 * (energy - 20) / 40 : 0.6 - 0.4 * (energy - 60) / 40;
            ck_assert_double_eq_tol(swank * straight, truth, 16 * DBL_EPSILON);
        }
    double swank = 0;
    ck_skg_fails(skg_response_swank_get(measured, 19, 1, &swank), SKG_ERR_BEAM, "outside the detector DQE's");
    ck_skg(skg_response_create_dqe(layer, 3, kev, high, &wrong));
    ck_skg_fails(skg_response_swank_get(wrong, 60, 1, &swank), SKG_ERR_BEAM,
                 "a DQE of 0.9 at 60 keV is more than");
    skg_response_release(&wrong);
    skg_response_release(&measured);
    skg_response_release(&layer);
    skg_material_release(&csi);
}
END_TEST

START_TEST(refused) {
    const double kev[2] = {10, 20};
    skg_response_table table;
    skg_response *response = NULL, *escaping = NULL;
    skg_material *unknown = NULL;
    skg_response_table_init(&table);
    table.count = 2, table.energies_kev = table.recorded_kev = kev;
    ck_skg(skg_response_create_table(&table, &response));
    ck_skg_fails(skg_response_create_escaping(response, &escaping), SKG_ERR_BEAM, "not from a table");
    ck_assert_ptr_null(escaping);
    skg_response_release(&response);
    ck_skg_fails(skg_response_create_escaping(NULL, &escaping), SKG_ERR_ARGUMENT, "scintillator");
    ck_skg(skg_material_create_table("crystal", 2, kev, kev, &unknown));
    skg_escape *escape = NULL;
    ck_skg_fails(skg_escape_create(unknown, 1, &escape), SKG_ERR_MATERIAL, "composition is not known");
    ck_assert_ptr_null(escape);
    skg_material_release(&unknown);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, thick_layer);
    tcase_add_test(tests, thin_layer);
    tcase_add_test(tests, nothing_escapes);
    tcase_add_test(tests, measured_dqe);
    tcase_add_test(tests, refused);
}

SKG_SUITE_MAIN("escape", add_tests)
