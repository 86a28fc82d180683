/* Cross sections against xraylib's CS_Total (another table and another interpolation), up to its 800 keV.
 *
 * Exceptions. 650 and 750 keV are no rows of xraylib's table: it interpolates there. In `ringing`, a row
 * stands 11 to 460 eV beside an edge and does not agree with the edge's row (Cr: 514.00 at 5.9892 keV, 514.24
 * at 6 keV); xraylib's spline goes through both and swings. Left-out points (element_test) and neighbouring
 * elements say that ours does not: at Cr's 8 keV the two ways miss the left-out row by 1.2 % (ours) and 20.6
 * %. */
#include "material/scattering.h"
#include "suite.h"

#include <math.h>
#include <string.h>
#include <xraylib.h>

static const struct {
    int32_t z;
    double bar;
} ringing[] = {{22, 0.06},  {24, 0.13},  {30, 0.010}, {50, 0.025}, {65, 0.008},
               {66, 0.008}, {69, 0.055}, {78, 0.04},  {86, 0.05}};

static double bar_of(int32_t z, double bar) {
    for (size_t i = 0; i < sizeof ringing / sizeof *ringing; i++)
        if (ringing[i].z == z && ringing[i].bar > bar) return ringing[i].bar;
    return bar;
}

static double deviation(int32_t z, double kev) {
    double s[SKG_PROCESSES], theirs = CS_Total(z, kev, NULL);
    skg_element_sections(z, kev, s);
    return theirs > 0 ? (s[0] + s[1] + s[2] + s[3]) / theirs - 1 : 1;
}

static int near_edge(int32_t z, double kev, double around) {
    for (int32_t i = skg_elements[z].first + 1; i < skg_elements[z].last; i++)
        if (!(skg_knots[i].energy_kev > skg_knots[i - 1].energy_kev) &&
            fabs(skg_knots[i].energy_kev - kev) <= around)
            return 1;
    return 0;
}

START_TEST(agrees_at_grid_energies) {
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int32_t i = skg_elements[z].first; i < skg_elements[z].last; i++) {
            double kev = skg_knots[i].energy_kev;
            if (kev < 10 || kev > 800 || near_edge(z, kev, 0.01)) continue;
            double bar = kev >= 650 && kev < 800 ? 8e-4 : 4.2e-4; /* germanium at 30 keV: 0.041 % */
            double d = fabs(deviation(z, kev));
            ck_assert_msg(d <= bar, "Z %d, %g keV: %.4f %%", (int)z, kev, 100 * d);
        }
}
END_TEST

/* 200 energies, 10 eV around edges left out. */
static void between(double low, double high, double bar) {
    enum { ENERGIES = 200 };
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int i = 0; i < ENERGIES; i++) {
            double kev = low * pow(high / low, (i + 0.5) / ENERGIES);
            if (near_edge(z, kev, 0.01)) continue;
            double d = fabs(deviation(z, kev));
            ck_assert_msg(d <= bar_of(z, bar), "Z %d, %g keV: %.3f %%", (int)z, kev, 100 * d);
        }
}

START_TEST(agrees_between_from_10_keV) {
    between(10, 799, 7e-3);
}
END_TEST

START_TEST(agrees_between_from_5_keV) {
    between(5, 10, 1e-2);
}
END_TEST

/* F^2 and S between the rows of materials/scattering.txt, which come from this library. */
START_TEST(scattering_agrees_between_the_rows) {
    enum { STEPS = 500 };
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int i = 0; i < STEPS; i++) {
            const double x = 0.005 * pow(10 / 0.005, (i + 0.5) / STEPS);
            const double form = FF_Rayl(z, x, NULL), theirs = SF_Compt(z, x, NULL);
            double own[SKG_SCATTERINGS];
            skg_atom_scattering(z, x, own);
            /* Measured: 1.14e-3 to 1/Angstrom (beryllium). Above it xraylib's
             * spline over steps of 0.25 to 2 swings: it misses the exact F^2 of hydrogen by 2 %, ours by 0.03 %. */
            const double bar = x < 1 ? 1.2e-3 : 3e-2;
            ck_assert_msg(fabs(own[SKG_COHERENT] / (form * form) - 1) <= bar, "F^2 of Z %d at %g: %.2e",
                          (int)z, x, own[SKG_COHERENT] / (form * form) - 1);
            /* Measured: 3.1e-4 from 0.02/Angstrom. Below it, where S is 1e-3 of Z, xraylib's spline starts from a straight
             * line (1.4e-2). */
            ck_assert_msg(fabs(own[SKG_INCOHERENT] / theirs - 1) <= (x < 0.02 ? 2e-2 : 5e-4),
                          "S of Z %d at %g: %.2e", (int)z, x, own[SKG_INCOHERENT] / theirs - 1);
        }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, agrees_at_grid_energies);
    tcase_add_test(tests, agrees_between_from_10_keV);
    tcase_add_test(tests, agrees_between_from_5_keV);
    tcase_add_test(tests, scattering_agrees_between_the_rows);
}

SKG_SUITE_MAIN("xraylib", add_tests)
