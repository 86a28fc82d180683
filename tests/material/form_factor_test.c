/* Form factors of molecules: scale, ends, copies, refusals. */
#include "material/scattering.h"
#include "suite.h"
#include "support/named.h"

#include <math.h>

enum { ROWS = 41 };

/* Rows of a bump at .2/Angstrom on the F^2 of free atoms, in any unit, up to .5/Angstrom. */
static void fill(const skg_material *material, double unit, double x[ROWS], double squares[ROWS]) {
    for (int i = 0; i < ROWS; i++) {
        double incoherent = 0;
        x[i] = 0.02 + 0.48 * i / (ROWS - 1);
        ck_skg(skg_scattering_free(material, x[i], &squares[i], &incoherent));
        squares[i] *= unit * (1 + exp(-pow((x[i] - 0.2) / 0.03, 2)));
    }
}

static double coherent_of(const skg_material *material, double x, int free) {
    double coherent = 0, incoherent = 0, other = 0;
    ck_skg(skg_scattering_free(material, x, free ? &coherent : &other, &incoherent));
    if (free) return coherent;
    ck_skg(skg_scattering_factors(material, x, &coherent, &other));
    ck_assert_double_eq(other, incoherent); /* Compton scattering is not changed */
    return coherent;
}

START_TEST(squares_have_any_unit) {
    static const double units[] = {1, 3e-22, 7};
    skg_material *water = named("Water, Liquid");
    double x[ROWS], squares[ROWS];
    for (int u = 0; u < 3; u++) {
        skg_material *bound = NULL, *dense = NULL;
        fill(water, units[u], x, squares);
        ck_skg(skg_material_create_form_factor(water, ROWS, x, squares, &bound));
        ck_skg(skg_material_create_at_density(bound, 0.9, &dense));
        skg_material_release(&bound);
        for (int i = 0; i < ROWS - 1; i++) {
            const double expected = coherent_of(water, x[i], 1) * (1 + exp(-pow((x[i] - 0.2) / 0.03, 2)));
            /* The bump is 1e-19 where the table is scaled; rounding. */
            ck_assert_double_eq_tol(coherent_of(dense, x[i], 0) / expected, 1, 1e-12);
        }
        /* Before the first row it holds; from the last one on atoms are free. */
        ck_assert_double_eq(coherent_of(dense, 0, 0), coherent_of(dense, x[0], 0));
        ck_assert_double_eq(coherent_of(dense, x[ROWS - 1], 0), coherent_of(water, x[ROWS - 1], 1));
        ck_assert_double_eq(coherent_of(dense, 3, 0), coherent_of(water, 3, 1));
        /* Linear between rows: the mean in the middle, but for rounding. */
        ck_assert_double_eq_tol(coherent_of(dense, 0.5 * (x[10] + x[11]), 0),
                                0.5 * (coherent_of(dense, x[10], 0) + coherent_of(dense, x[11], 0)),
                                1e-12 * coherent_of(dense, x[10], 0));
        skg_material_release(&dense);
    }
    skg_material_release(&water);
}
END_TEST

START_TEST(tables_are_given_back) {
    skg_material *water = named("Water, Liquid"), *bound = NULL, *again = NULL;
    double x[ROWS], squares[ROWS], own[ROWS], back[ROWS];
    int64_t count = -1;
    fill(water, 1, x, squares);
    ck_skg(skg_material_form_factor_get(water, 0, NULL, NULL, &count));
    ck_assert_int_eq(count, 0);
    ck_skg(skg_material_create_form_factor(water, ROWS, x, squares, &bound));
    ck_skg(skg_material_form_factor_get(bound, 2, own, back, &count));
    ck_assert_int_eq(count, ROWS);
    ck_skg(skg_material_form_factor_get(bound, ROWS, own, back, &count));
    ck_skg(skg_material_create_form_factor(water, ROWS, own, back, &again));
    for (int i = 0; i < ROWS; i++) {
        ck_assert_double_eq(own[i], x[i]);
        ck_assert_double_eq_tol(coherent_of(again, x[i], 0) / coherent_of(bound, x[i], 0), 1,
                                1e-12); /* rounding */
    }
    ck_skg_fails(skg_material_form_factor_get(bound, 1, NULL, back, &count), SKG_ERR_ARGUMENT,
                 "room for 1 rows");
    skg_material_release(&again);
    skg_material_release(&bound);
    skg_material_release(&water);
}
END_TEST

START_TEST(refusals_name_the_row) {
    static const struct {
        int64_t count;
        double x[3], squares[3];
        const char *says;
    } bad[] = {
        {1, {0.5}, {1}, "at least two rows"},
        {3, {0, 0.1, 0.1}, {1, 1, 1}, "row 3: momentum transfers have to rise"},
        {3, {-1, 0.1, 0.5}, {1, 1, 1}, "row 1 (-1/Angstrom, 1)"},
        {3,
         {0, 0.1, 0.5},
         {1, 0, 1},
         "row 2 (0.1/Angstrom, 0): a momentum transfer is at least 0, a square above 0"},
        {3, {0, 0.1, (double)INFINITY}, {1, 1, 1}, "row 3"},
        {3, {0, 0.1, 0.3}, {1, 1, 1}, "ends at 0.3/Angstrom; it has to reach 0.4"},
    };
    skg_material *water = named("Water, Liquid"), *grey = NULL, *none = NULL, *bound = NULL;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ck_skg_fails(skg_material_create_form_factor(water, bad[k].count, bad[k].x, bad[k].squares, &bound),
                     SKG_ERR_MATERIAL, bad[k].says);
        ck_assert_ptr_null(bound);
    }
    const double x[2] = {0, 0.5}, squares[2] = {1, 1};
    ck_skg(skg_material_create_mu("grey", 0.5, &grey));
    ck_skg(skg_material_create_named("Vacuum", &none));
    ck_skg_fails(skg_material_create_form_factor(grey, 2, x, squares, &bound), SKG_ERR_MATERIAL,
                 "grey: a material given by");
    ck_skg_fails(skg_material_create_form_factor(none, 2, x, squares, &bound), SKG_ERR_MATERIAL,
                 "scatters nothing");
    skg_material_release(&water);
    skg_material_release(&grey);
    skg_material_release(&none);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, squares_have_any_unit);
    tcase_add_test(tests, tables_are_given_back);
    tcase_add_test(tests, refusals_name_the_row);
}

SKG_SUITE_MAIN("form_factor", add_tests)
