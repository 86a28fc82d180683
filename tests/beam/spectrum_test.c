/* Spectra of the caller and from files, filters, half-value layers, energy responses. */
#include <skiagraph/beam.h>

#include "suite.h"
#include "support/named.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

static void expect(const skg_spectrum *s, int64_t count, const double *energies, const double *photons) {
    int64_t size = 0;
    ck_skg(skg_spectrum_bin_count(s, &size));
    ck_assert_int_eq(size, count);
    for (int64_t i = 0; i < count; i++) {
        double e = 0, n = 0;
        ck_skg(skg_spectrum_bin_get(s, i, &e, &n));
        ck_assert_double_eq_tol(e, energies[i], 4 * DBL_EPSILON * energies[i]);
        ck_assert_double_eq_tol(n, photons[i], 16 * DBL_EPSILON * photons[i]);
    }
}

START_TEST(bins_are_sorted_and_merged) {
    static const double e[5] = {80, 60, 80, 100, 70}, n[5] = {1, 2, 3, 0, 5};
    skg_spectrum *s = NULL;
    ck_skg(skg_spectrum_create_bins(5, e, n, &s));
    expect(s, 3, (double[3]){60, 70, 80}, (double[3]){2, 5, 4});
    skg_spectrum_release(&s);
    ck_skg_fails(skg_spectrum_create_bins(0, e, n, &s), SKG_ERR_BEAM, "at least one");
    ck_skg_fails(skg_spectrum_create_bins(1, e + 3, n + 3, &s), SKG_ERR_BEAM, "without photons");
    ck_skg_fails(skg_spectrum_create_bins(1, e, (double[1]){-1}, &s), SKG_ERR_BEAM, "-1 photons");
    ck_skg_fails(skg_spectrum_create_bins(1, (double[1]){0.5}, n, &s), SKG_ERR_BEAM, "outside");
    ck_skg_fails(skg_spectrum_create_bins(1, (double[1]){(double)NAN}, n, &s), SKG_ERR_BEAM, "outside");
}
END_TEST

/* Finite numbers whose sum is not. */
START_TEST(more_photons_than_a_double_holds) {
    static const double e[3] = {60, 70, 80}, n[3] = {1e306, 1e306, 1e306};
    skg_spectrum *s = NULL, *more = NULL;
    ck_skg_fails(skg_spectrum_create_bins(3, e, n, &s), SKG_ERR_BEAM, "fewer photons");
    ck_skg_fails(skg_spectrum_create_mono(100, 1e308, &s), SKG_ERR_BEAM, "fewer photons");
    ck_skg(skg_spectrum_create_mono(100, 1e300, &s));
    ck_skg_fails(skg_spectrum_create_scaled(s, 1e10, &more), SKG_ERR_BEAM, "fewer photons");
    ck_assert_ptr_null(more);
    skg_spectrum_release(&s);
}
END_TEST

static void write_file(char *path, const char *text) {
    int file = mkstemp(path);
    ck_assert_int_ge(file, 0);
    ck_assert_int_eq(write(file, text, strlen(text)), (int)strlen(text));
    close(file);
}

START_TEST(files_of_two_columns) {
    char path[] = "/tmp/skg_spectrum_XXXXXX";
    write_file(path, "Energy,Photons\n# comment\n0.06, 2e3\n0.07;5\n\n.08\t1.5e+1\r\n");
    skg_spectrum *s = NULL;
    ck_skg(skg_spectrum_load(path, "MeV", &s));
    expect(s, 3, (double[3]){60, 70, 80}, (double[3]){2000, 5, 15});
    skg_spectrum_release(&s);
    ck_skg_fails(skg_spectrum_load(path, "keV", &s), SKG_ERR_BEAM, path); /* 0.06 keV */
    unlink(path);
    ck_skg_fails(skg_spectrum_load(path, "keV", &s), SKG_ERR_FILE, path);
}
END_TEST

START_TEST(gate_macros) {
    char path[] = "/tmp/skg_macro_XXXXXX";
    write_file(path,
               "# beam\n/gate/source/mybeam/gps/emin 0.01 MeV\n/gate/source/mybeam/gps/histpoint 0.02 3\n"
               "/gate/source/mybeam/gps/histpoint 0.03 4\n");
    skg_spectrum *s = NULL;
    ck_skg(skg_spectrum_load(path, "MeV", &s));
    expect(s, 2, (double[2]){20, 30}, (double[2]){3, 4});
    skg_spectrum_release(&s);
    unlink(path);
    char bad[] = "/tmp/skg_macro_XXXXXX";
    write_file(bad, "/gps/hist/point 0.02 3\n/gps/hist/point 0.03\n");
    ck_skg_fails(skg_spectrum_load(bad, "MeV", &s), SKG_ERR_FORMAT, "line 2");
    unlink(bad);
}
END_TEST

/* Of one energy, the half-value layers are ln 2 / mu, both. */
START_TEST(half_value_layers_of_one_energy) {
    skg_spectrum *s = NULL;
    skg_quality q;
    skg_quality_init(&q);
    skg_material *al = named("Al");
    double mu = 0;
    ck_skg(skg_material_attenuation_get(al, 60, &mu));
    ck_skg(skg_spectrum_create_mono(60, 7, &s));
    ck_skg(skg_spectrum_quality_get(s, &q));
    /* Found by a search that stops at a few epsilons of the layer. */
    ck_assert_double_eq_tol(q.hvl1_mm_al, 10 * log(2) / mu, 1024 * DBL_EPSILON * 10);
    ck_assert_double_eq_tol(q.homogeneity, 1, 1024 * DBL_EPSILON);
    ck_assert_double_eq_tol(q.mean_kev, 60, 16 * DBL_EPSILON * 60);
    ck_assert_double_eq_tol(q.energy_kev, 420, 16 * DBL_EPSILON * 420);
    skg_spectrum_release(&s);
    skg_material_release(&al);
}
END_TEST

/* mu_en/rho of dry air by NIST (cm2/g): what air kerma has to be within 0.7 %. */
START_TEST(air_kerma_per_photon) {
    static const double rows[][2] = {{10, 4.742},   {15, 1.334},   {20, .5389},  {30, .1537},
                                     {40, .06833},  {50, .04098},  {60, .03041}, {80, .02407},
                                     {100, .02325}, {150, .02496}, {200, .02672}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        skg_spectrum *s = NULL;
        skg_quality q;
        skg_quality_init(&q);
        ck_skg(skg_spectrum_create_mono(rows[i][0], 1, &s));
        ck_skg(skg_spectrum_quality_get(s, &q));
        double expected = 100 * rows[i][0] * 1.602176634e-16 * rows[i][1] * 1e9;
        /* Two tables of mass energy absorption of air differ by 0.7 % at most. */
        ck_assert_msg(fabs(q.air_kerma_ugy / expected - 1) < 7e-3, "%g keV: %+.2f %%", rows[i][0],
                      100 * (q.air_kerma_ugy / expected - 1));
        skg_spectrum_release(&s);
    }
}
END_TEST

START_TEST(filters_harden) {
    static const double e[2] = {30, 80}, n[2] = {1000, 1000};
    skg_material *copper = named("Cu"), *gas = named("Ca5(PO4)3OH");
    skg_filter filter = {.size = (int32_t)sizeof filter, .material = copper, .thickness_mm = 0.5};
    skg_spectrum *s = NULL, *behind = NULL;
    double low = 0, high = 0;
    ck_skg(skg_spectrum_create_bins(2, e, n, &s));
    ck_skg(skg_spectrum_create_filtered(s, 1, &filter, &behind));
    ck_skg(skg_material_attenuation_get(copper, 30, &low));
    ck_skg(skg_material_attenuation_get(copper, 80, &high));
    expect(behind, 2, e, (double[2]){1000 * exp(-0.05 * low), 1000 * exp(-0.05 * high)});
    skg_spectrum_release(&behind);
    filter.thickness_mm = 5; /* nothing worth the name is left of 30 keV */
    ck_skg(skg_spectrum_create_filtered(s, 1, &filter, &behind));
    expect(behind, 1, e + 1, (double[1]){1000 * exp(-0.5 * high)});
    skg_spectrum_release(&behind);
    filter.thickness_mm = -1;
    ck_skg_fails(skg_spectrum_create_filtered(s, 1, &filter, &behind), SKG_ERR_BEAM, "-1 mm");
    filter.material = gas, filter.thickness_mm = 1;
    ck_skg_fails(skg_spectrum_create_filtered(s, 1, &filter, &behind), SKG_ERR_MATERIAL, "density");
    skg_spectrum_release(&s);
    skg_material_release(&copper);
    skg_material_release(&gas);
}
END_TEST

/* Numbers in print, as gVXR's users have them. */
START_TEST(response_of_cesium_iodide_in_print) {
    static const double rows[][2] = {{30, 27.4}, {33, 28.1},  {35, 34.8}, {60, 53.0},
                                     {80, 50.4}, {100, 42.3}, {160, 24.9}};
    skg_material *csi = named("CsI");
    skg_response *layer = NULL, *screen = NULL;
    ck_skg(skg_response_create_scintillator(csi, 0.6, 1, &layer));
    ck_skg(skg_response_create_screen(csi, 4.51 * 60, &screen)); /* mg/cm2 */
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double r = 0, s = 0;
        ck_skg(skg_response_get(layer, rows[i][0], 1, &r, NULL));
        ck_skg(skg_response_get(screen, rows[i][0], 1, &s, NULL));
        /* Half a unit of the last digit in print, and a tenth of that for the table behind it. */
        ck_assert_double_eq_tol(r, rows[i][1], 0.055);
        ck_assert_double_eq_tol(s, r, 64 * DBL_EPSILON * r);
    }
    skg_response_release(&layer);
    skg_response_release(&screen);
    double full = 0, packed = 0, oblique = 0; /* more on a longer path, less of less matter */
    ck_skg(skg_response_create_scintillator(csi, 0.5, 0.8, &layer));
    ck_skg(skg_response_get(layer, 60, 1, &packed, NULL));
    ck_skg(skg_response_get(layer, 60, 1.25, &oblique, NULL));
    skg_response_release(&layer);
    ck_skg(skg_response_create_scintillator(csi, 0.5, 1, &layer));
    ck_skg(skg_response_get(layer, 60, 1, &full, NULL));
    ck_assert_double_eq_tol(oblique, full, 64 * DBL_EPSILON * full);
    ck_assert_double_lt(packed, full);
    skg_response_release(&layer);
    ck_skg_fails(skg_response_create_scintillator(csi, 0, 1, &layer), SKG_ERR_BEAM, "0 mm");
    ck_skg_fails(skg_response_create_scintillator(csi, 1, 1.1, &layer), SKG_ERR_BEAM, "packing");
    skg_material_release(&csi);
}
END_TEST

/* A table of three energies, 10 to 100 keV, of which tests change what they look at. */
static skg_response_table three(void) {
    static const double e[3] = {10, 50, 100}, r[3] = {10, 40, 60};
    skg_response_table table;
    skg_response_table_init(&table);
    table.count = 3, table.energies_kev = e, table.recorded_kev = r;
    return table;
}

START_TEST(response_tables) {
    static const double eta[3] = {1, 0.9, 0.8}, swank[3] = {1, 0.9, 0.7}, none[3] = {1, 0, 1};
    skg_response *t = NULL;
    double recorded = 0, seen = 0, factor = 0;
    skg_response_table table = three();
    ck_skg(skg_response_create_table(&table, &t)); /* a signal: every photon is recorded */
    ck_skg(skg_response_get(t, 30, 1, &recorded, &seen));
    ck_assert_double_eq_tol(recorded, 25, 16 * DBL_EPSILON * 25);
    ck_assert_double_eq(seen, 1);
    ck_skg_fails(skg_response_get(t, 101, 1, &recorded, &seen), SKG_ERR_BEAM, "10 to 100 keV");
    skg_response_release(&t);
    table.meaning = SKG_RESPONSE_MEANING_ABSORBED;
    ck_skg(skg_response_create_table(&table, &t)); /* all or nothing */
    ck_skg(skg_response_get(t, 30, 1, &recorded, &seen));
    ck_assert_double_eq_tol(recorded, 25, 16 * DBL_EPSILON * 25);
    ck_assert_double_eq_tol(seen, 25.0 / 30, 16 * DBL_EPSILON);
    ck_skg(skg_response_swank_get(t, 30, 1, &factor));
    ck_assert_double_eq(factor, 1);
    skg_response_release(&t);
    table.efficiency = eta;
    ck_skg_fails(skg_response_create_table(&table, &t), SKG_ERR_BEAM, "leave the efficiencies out");
    table.meaning = SKG_RESPONSE_MEANING_SIGNAL, table.swank = swank;
    ck_skg(skg_response_create_table(&table, &t));
    ck_skg(skg_response_get(t, 75, 1, &recorded, &seen));
    ck_assert_double_eq_tol(seen, 0.85, 16 * DBL_EPSILON);
    ck_skg(skg_response_swank_get(t, 75, 1, &factor));
    ck_assert_double_eq_tol(factor, 0.8, 16 * DBL_EPSILON);
    skg_response_release(&t);
    ck_skg(skg_response_get(NULL, 75, 1, &recorded, &seen)); /* ideal */
    ck_skg(skg_response_swank_get(NULL, 75, 1, &factor));
    ck_assert_double_eq(recorded, 75);
    ck_assert_double_eq(seen, 1);
    ck_assert_double_eq(factor, 1);
    table.efficiency = none;
    ck_skg_fails(skg_response_create_table(&table, &t), SKG_ERR_BEAM,
                 "row 2: 40 keV recorded with efficiency 0");
    table = three(), table.swank = none;
    ck_skg_fails(skg_response_create_table(&table, &t), SKG_ERR_BEAM, "row 2: Swank factor 0");
    table = three(), table.meaning = 2;
    ck_skg_fails(skg_response_create_table(&table, &t), SKG_ERR_BEAM, "meaning 2");
    table = three(), table.recorded_kev = (double[3]){1, 52, 3};
    ck_skg_fails(skg_response_create_table(&table, &t), SKG_ERR_BEAM,
                 "row 2: 52 keV recorded of a photon of 50");
}
END_TEST

START_TEST(response_files) {
    skg_response *t = NULL;
    double recorded = 0, seen = 0, factor = 0;
    char path[] = "/tmp/skg_response_XXXXXX";
    write_file(path, "0.01 0.01\n0.1 0.06\n");
    ck_skg(skg_response_load(path, "MeV", SKG_RESPONSE_MEANING_ABSORBED, &t));
    ck_skg(skg_response_get(t, 100, 1, &recorded, &seen));
    ck_assert_double_eq_tol(recorded, 60, 16 * DBL_EPSILON * 60);
    ck_assert_double_eq_tol(seen, 0.6, 16 * DBL_EPSILON);
    skg_response_release(&t);
    unlink(path);
    char other[] = "/tmp/skg_response_XXXXXX";
    write_file(other, "E R eta A\n10, 10, 0.9, 1\n100, 60, 0.7, 0.8\n");
    ck_skg(skg_response_load(other, "keV", SKG_RESPONSE_MEANING_SIGNAL, &t));
    ck_skg(skg_response_get(t, 55, 1, &recorded, &seen));
    ck_skg(skg_response_swank_get(t, 55, 1, &factor));
    ck_assert_double_eq_tol(recorded, 35, 16 * DBL_EPSILON * 35);
    ck_assert_double_eq_tol(seen, 0.8, 16 * DBL_EPSILON);
    ck_assert_double_eq_tol(factor, 0.9, 16 * DBL_EPSILON);
    skg_response_release(&t);
    unlink(other);
    char bad[] = "/tmp/skg_response_XXXXXX";
    write_file(bad, "10 10 0.9\n100 60\n");
    ck_skg_fails(skg_response_load(bad, "keV", SKG_RESPONSE_MEANING_SIGNAL, &t), SKG_ERR_FORMAT,
                 "line 2: there are two numbers, but three in the first row");
    unlink(bad);
}
END_TEST

/* A quarter of the photons of 40 keV escape, a quarter leave 10 keV and half all of it; at 80 keV all leave 60. */
START_TEST(pulse_heights) {
    static const double e[2] = {40, 80}, h[3] = {10, 40, 60};
    double p[6] = {0.25, 0.5, 0, 0, 0, 1}, recorded = 0, seen = 0, factor = 0;
    skg_response *t = NULL;
    ck_skg(skg_response_create_pulses(2, e, 3, h, p, &t));
    ck_skg(skg_response_get(t, 40, 1, &recorded, &seen));
    ck_skg(skg_response_swank_get(t, 40, 1, &factor));
    ck_assert_double_eq_tol(recorded, 22.5, 16 * DBL_EPSILON * 22.5);
    ck_assert_double_eq_tol(seen, 0.75, 16 * DBL_EPSILON);
    ck_assert_double_eq_tol(factor, 22.5 * 22.5 / (0.75 * 825), 16 * DBL_EPSILON);
    ck_skg(skg_response_get(t, 80, 1, &recorded, &seen));
    ck_skg(skg_response_swank_get(t, 80, 1, &factor));
    ck_assert_double_eq_tol(recorded, 60, 16 * DBL_EPSILON * 60);
    ck_assert_double_eq_tol(seen * factor, 1, 16 * DBL_EPSILON);
    skg_response_release(&t);
    p[5] = 1.5;
    ck_skg_fails(skg_response_create_pulses(2, e, 3, h, p, &t), SKG_ERR_BEAM, "row 2: a probability of 1.5");
    p[5] = 1, p[3] = 0.5;
    ck_skg_fails(skg_response_create_pulses(2, e, 3, h, p, &t), SKG_ERR_BEAM,
                 "row 2: probabilities sum to 1.5");
    ck_skg_fails(skg_response_create_pulses(2, e, 2, (double[2]){40, 40}, p, &t), SKG_ERR_BEAM, "height 2");
}
END_TEST

/* AAPM TG-195, case 1 (I. Sechopoulos et al., Medical Physics 42 (2015) 5679-5691): the air kerma behind two thicknesses of aluminium over that
 * without, on average of four Monte Carlo programs. */
START_TEST(aluminium_transmits_what_tg_195_has) {
    static const struct {
        double kev, mm[2], kerma[3];
    } cases[] = {{30, {2.273, 4.546}, {5.732642e-2, 2.868487e-2, 1.435717e-2}},
                 {100, {15.11, 30.22}, {2.902460e-2, 1.448180e-2, 7.226802e-3}}};
    for (int c = 0; c < 2; c++) {
        skg_spectrum *s = NULL;
        skg_quality q;
        skg_quality_init(&q);
        ck_skg(skg_spectrum_create_mono(cases[c].kev, 1, &s));
        ck_skg(skg_spectrum_quality_get(s, &q));
        for (int k = 0; k < 2; k++) {
            const double ours = pow(0.5, cases[c].mm[k] / q.hvl1_mm_al);
            printf("%g keV, %g mm: %.5f, published %.5f\n", cases[c].kev, cases[c].mm[k], ours,
                   cases[c].kerma[1 + k] / cases[c].kerma[0]);
            /* 0.1 %: four programs and their cross sections */
            ck_assert_double_eq_tol(ours * cases[c].kerma[0] / cases[c].kerma[1 + k], 1, 1e-3);
        }
        skg_spectrum_release(&s);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, aluminium_transmits_what_tg_195_has);
    tcase_add_test(tests, bins_are_sorted_and_merged);
    tcase_add_test(tests, more_photons_than_a_double_holds);
    tcase_add_test(tests, files_of_two_columns);
    tcase_add_test(tests, gate_macros);
    tcase_add_test(tests, half_value_layers_of_one_energy);
    tcase_add_test(tests, air_kerma_per_photon);
    tcase_add_test(tests, filters_harden);
    tcase_add_test(tests, response_of_cesium_iodide_in_print);
    tcase_add_test(tests, response_tables);
    tcase_add_test(tests, response_files);
    tcase_add_test(tests, pulse_heights);
}

SKG_SUITE_MAIN("spectrum", add_tests)
