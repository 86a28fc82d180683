/* Cross sections against xraylib's CS_Total (another table and another interpolation), up to its 800 keV. */
#include "material/material.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <xraylib.h>

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
    double worst = 0, at = 0;
    int worst_z = 0;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int32_t i = skg_elements[z].first; i < skg_elements[z].last; i++) {
            double kev = skg_knots[i].energy_kev;
            if (kev < 10 || kev > 800 || near_edge(z, kev, 0.01)) continue;
            double d = fabs(deviation(z, kev));
            if (d > worst) worst = d, worst_z = z, at = kev;
            if (getenv("SKG_LIST") && d > 4e-4) printf("grid Z %d %g keV %.3f %%\n", z, kev, 100 * d);
        }
    printf("grid energies from 10 keV: worst %.4f %% at Z %d, %g keV\n", 100 * worst, worst_z, at);
    ck_assert_double_le(worst, 4e-4);
}
END_TEST

static void between(double low, double high, double bar) {
    enum { ENERGIES = 200 };
    double worst = 0, at = 0;
    int worst_z = 0;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int i = 0; i < ENERGIES; i++) {
            double kev = low * pow(high / low, (i + 0.5) / ENERGIES);
            if (near_edge(z, kev, 0.01)) continue;
            double d = fabs(deviation(z, kev));
            if (d > worst) worst = d, worst_z = z, at = kev;
            if (getenv("SKG_LIST") && d > bar) printf("between Z %d %g keV %.3f %%\n", z, kev, 100 * d);
        }
    printf("%g to %g keV: worst %.3f %% at Z %d, %g keV\n", low, high, 100 * worst, worst_z, at);
    ck_assert_double_le(worst, bar);
}

START_TEST(agrees_between_from_10_keV) {
    between(10, 799, 7e-3);
}
END_TEST

START_TEST(agrees_between_from_5_keV) {
    between(5, 10, 1e-2);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, agrees_at_grid_energies);
    tcase_add_test(tests, agrees_between_from_10_keV);
    tcase_add_test(tests, agrees_between_from_5_keV);
}

SKG_SUITE_MAIN("xraylib", add_tests)
