/* Form factors and scattering functions: the exact hydrogen atom, limits, and XCOM's cross sections as integrals. */
#include "material/scattering.h"
#include "suite.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* 1,022 keV turned back. */
static const double HIGHEST_MOMENTUM = 82.43;

/* The ground state of hydrogen has F = 1/(1 + (2 pi a x)^2)^2 with the Bohr radius a, and S = 1 - F^2. */
START_TEST(hydrogen_is_exact) {
    const double bohr_angstrom = 0.529177210903;
    for (int i = 0; i <= 400; i++) {
        const double x = i == 0 ? 0 : 1e-3 * pow(100 / 1e-3, i / 400.0);
        const double reduced = pow(2 * PI * bohr_angstrom * x, 2), form = 1 / pow(1 + reduced, 2);
        double own[SKG_SCATTERINGS];
        skg_atom_scattering(1, x, own);
        /* Five digits of F and S, and the interpolation between 41 steps (measured: 2.5e-4). */
        const double bar = 3e-4;
        ck_assert_msg(fabs(own[SKG_COHERENT] / (form * form) - 1) <= bar, "F^2 at %g: %.3e", x,
                      own[SKG_COHERENT] / (form * form) - 1);
        /* Before the first row, at 0.005/Angstrom, c x^2: there the exact S is 7e-4 below. */
        const double inbar = x < 0.005 ? 1e-3 : bar;
        if (i > 0)
            ck_assert_msg(fabs(own[SKG_INCOHERENT] / (1 - form * form) - 1) <= inbar, "S at %g: %.3e", x,
                          own[SKG_INCOHERENT] / (1 - form * form) - 1);
    }
}
END_TEST

START_TEST(limits_are_those_of_the_electrons) {
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++) {
        double own[SKG_SCATTERINGS];
        skg_atom_scattering(z, 0, own);
        ck_assert_double_eq(own[SKG_COHERENT], (double)z * z);
        ck_assert_double_eq(own[SKG_INCOHERENT], 0);
        skg_atom_scattering(z, HIGHEST_MOMENTUM, own);
        ck_assert_double_eq_tol(own[SKG_INCOHERENT], z, 1e-4 * z); /* uranium's 1s electrons: 1e-4 */
        skg_atom_scattering(z, 1e4, own);
        ck_assert_double_eq(own[SKG_INCOHERENT], z);
        ck_assert_double_gt(own[SKG_COHERENT], 0);
        ck_assert_double_lt(own[SKG_COHERENT], 1e-12 * z * z); /* 100^-8 of F^2 at 100/Angstrom */
    }
}
END_TEST

/* Over steps of 1 %, so across the ends of the table too. */
START_TEST(more_momentum_is_less_coherent) {
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++) {
        double before[SKG_SCATTERINGS], own[SKG_SCATTERINGS];
        skg_atom_scattering(z, 0, before);
        for (double x = 1e-3; x < 300; x *= 1.01) {
            skg_atom_scattering(z, x, own);
            ck_assert_msg(own[SKG_COHERENT] < before[SKG_COHERENT], "F of Z %d rises at %g", (int)z, x);
            /* Where S is flat, five digits and the spline's swing between them. */
            ck_assert_msg(own[SKG_INCOHERENT] >= before[SKG_INCOHERENT] * (1 - 1e-4), "S of Z %d falls at %g",
                          (int)z, x);
            before[SKG_COHERENT] = own[SKG_COHERENT];
            before[SKG_INCOHERENT] = own[SKG_INCOHERENT];
        }
    }
}
END_TEST

/* Klein and Nishina's cross section of a free electron over r_e^2, per solid angle. cosine: of the angle */
static double klein_nishina(double kev, double cosine) {
    const double left = 1 / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
    return left * left * (left + 1 / left - (1 - cosine * cosine)) / 2;
}

/* Cross sections of an element in cm2/g as integrals over the sphere. With u = sin^2(theta/2) = v^4, 4 pi du is the
 * solid angle and the forward peak of F^2 is wide: the midpoint rule has 1e-6. */
static void integrate(int32_t z, double kev, double *coherent, double *incoherent) {
    enum { STEPS = 4000 };
    const double scale =
        SKG_ELECTRON_RADIUS_CM * SKG_ELECTRON_RADIUS_CM * SKG_AVOGADRO / skg_elements[z].weight;
    double sums[2] = {0};
    for (int i = 0; i < STEPS; i++) {
        const double v = (i + 0.5) / STEPS, u = v * v * v * v, cosine = 1 - 2 * u;
        const double solid = 4 * PI * 4 * v * v * v / STEPS;
        double own[SKG_SCATTERINGS];
        skg_atom_scattering(z, sqrt(u) * kev / SKG_HC_KEV_ANGSTROM, own);
        sums[0] += solid * (1 + cosine * cosine) / 2 * own[SKG_COHERENT];
        sums[1] += solid * klein_nishina(kev, cosine) * own[SKG_INCOHERENT];
    }
    *coherent = scale * sums[0];
    *incoherent = scale * sums[1];
}

/* XCOM's Rayleigh cross sections are integrals of relativistic form factors (Hubbell and Overbo 1979), which are larger at
 * large x in heavy atoms; its Compton cross sections have radiative corrections. The bars are the measured deviations (materials/README.md), rounded up. */
START_TEST(integrals_are_near_the_cross_sections) {
    static const struct {
        int32_t z;
        double rayleigh, compton;
    } rows[] = {{1, 5e-4, 5e-4},    {6, 1.5e-3, 3e-3},  {8, 4e-3, 4e-3},
                {13, 3e-3, 5e-3},   {20, 8.5e-3, 6e-3}, {26, 0.011, 8e-3},
                {53, 0.053, 0.011}, {74, 0.085, 0.014}, {82, 0.104, 0.014}};
    static const double energies[] = {30, 60, 100, 300};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (size_t k = 0; k < sizeof energies / sizeof *energies; k++) {
            double section[SKG_PROCESSES], coherent, incoherent;
            skg_element_sections(rows[i].z, energies[k], section);
            integrate(rows[i].z, energies[k], &coherent, &incoherent);
            const double rayleigh = coherent / section[SKG_RAYLEIGH] - 1;
            const double compton = incoherent / section[SKG_COMPTON] - 1;
            ck_assert_msg(fabs(rayleigh) <= rows[i].rayleigh && fabs(compton) <= rows[i].compton,
                          "Z %d, %g keV: Rayleigh %+.2f %%, Compton %+.2f %%", (int)rows[i].z, energies[k],
                          100 * rayleigh, 100 * compton);
        }
}
END_TEST

START_TEST(material_is_the_sum_of_its_atoms) {
    skg_material *water = NULL;
    const double molecules = SKG_AVOGADRO / (2 * skg_elements[1].weight + skg_elements[8].weight);
    ck_skg(skg_material_create_formula("H2O", 1, &water));
    for (double x = 0; x < 20; x = 1.5 * x + 0.01) {
        double hydrogen[SKG_SCATTERINGS], oxygen[SKG_SCATTERINGS], coherent = 0, incoherent = 0;
        skg_atom_scattering(1, x, hydrogen);
        skg_atom_scattering(8, x, oxygen);
        ck_skg(skg_scattering_factors(water, x, &coherent, &incoherent));
        const double sums[] = {2 * hydrogen[0] + oxygen[0], 2 * hydrogen[1] + oxygen[1]};
        ck_assert_double_eq_tol(coherent, molecules * sums[0],
                                1e-13 * coherent); /* some sums of 1e-16 each */
        ck_assert_double_eq_tol(incoherent, molecules * sums[1], 1e-13 * molecules); /* as above */
    }
    skg_material_release(&water);
}
END_TEST

START_TEST(attenuation_alone_is_refused) {
    const double energies[] = {20, 100}, per_cm[] = {1, 0.2};
    skg_material *constant = NULL, *table = NULL;
    double coherent, incoherent;
    ck_skg(skg_material_create_mu("grey", 0.5, &constant));
    ck_skg(skg_material_create_table("rows", 2, energies, per_cm, &table));
    ck_skg_fails(skg_scattering_factors(constant, 1, &coherent, &incoherent), SKG_ERR_MATERIAL,
                 "grey: a material given by its attenuation alone");
    ck_skg_fails(skg_scattering_factors(table, 1, &coherent, &incoherent), SKG_ERR_MATERIAL,
                 "give a formula");
    skg_material_release(&constant);
    skg_material_release(&table);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, hydrogen_is_exact);
    tcase_add_test(tests, limits_are_those_of_the_electrons);
    tcase_add_test(tests, more_momentum_is_less_coherent);
    tcase_add_test(tests, integrals_are_near_the_cross_sections);
    tcase_add_test(tests, material_is_the_sum_of_its_atoms);
    tcase_add_test(tests, attenuation_alone_is_refused);
}

SKG_SUITE_MAIN("scattering", add_tests)
