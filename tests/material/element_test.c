/* Cross sections against the table they come from, and against themselves with a point left out. */
#include "material/material.h"
#include "materials/spline.h"
#include "suite.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static double total(int32_t z, double kev) {
    double s[SKG_PROCESSES];
    skg_element_sections(z, kev, s);
    return s[0] + s[1] + s[2] + s[3];
}

/* The rows of materials/xcom.txt. */
START_TEST(grid_energies_give_the_table) {
    FILE *file = fopen(SKG_SOURCE "/materials/xcom.txt", "r");
    ck_assert_ptr_nonnull(file);
    char line[256];
    int z = 0, rows = 0;
    double before = 0;
    while (fgets(line, sizeof line, file)) {
        double e, r, c, p, n;
        if (sscanf(line, "element %d", &z) == 1) before = 0;
        if (sscanf(line, "%lf %lf %lf %lf %lf", &e, &r, &c, &p, &n) != 5) continue;
        int above = !(e > before);
        before = e;
        if (e > 20000) continue;
        /* Below an edge: a hair below, since at the edge the value above counts. 1e-12 of ln E away changes
         * the value by less than 1e-10. */
        char next[256] = "";
        long place = ftell(file);
        double f = 0;
        if (fgets(next, sizeof next, file)) sscanf(next, "%lf", &f);
        fseek(file, place, SEEK_SET);
        double at = !above && !(f > e) ? e * (1 - 1e-12) : e, s[SKG_PROCESSES];
        if (f <= 0) at = e;
        skg_element_sections(z, at, s);
        /* exp(log(x)) and the spline's own rounding */
        ck_assert_double_le(fabs(s[SKG_RAYLEIGH] / r - 1), 1e-9);
        ck_assert_double_le(fabs(s[SKG_COMPTON] / c - 1), 1e-9);
        /* as above; the pair term starts at 0 */
        ck_assert_double_le(fabs(s[SKG_PHOTO] / p - 1), 1e-9);
        ck_assert_double_le(fabs(s[SKG_PAIR] - n), 1e-9 * n + 1e-15);
        rows++;
    }
    fclose(file);
    ck_assert_int_gt(rows, 6000);
}
END_TEST

/* A knot left out, away from edges: what the spline of the others says there. */
START_TEST(points_left_out_are_found_again) {
    double worst = 0, x[256], y[256], d[256], scratch[256];
    int worst_z = 0;
    double worst_kev = 0;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++) {
        int32_t last = skg_elements[z].last;
        for (int32_t i = skg_elements[z].first + 1; i < last - 1; i++) {
            /* the piece between edges, at least two knots away from its ends, and 5 keV and more */
            int32_t a = i, b = i;
            while (a > skg_elements[z].first && skg_knots[a].energy_kev > skg_knots[a - 1].energy_kev) a--;
            while (b + 1 < last && skg_knots[b + 1].energy_kev > skg_knots[b].energy_kev) b++;
            if (i - a < 3 || b - i < 3 || skg_knots[i].energy_kev < 5 || skg_knots[i].energy_kev > 900)
                continue;
            int n = 0;
            for (int32_t k = a; k <= b; k++)
                if (k != i) x[n] = skg_knots[k].log_energy, y[n++] = skg_knots[k].value[SKG_PHOTO];
            skg_spline_piece(n, x, y, d, scratch);
            int j = i - a;
            double yy[2] = {y[j - 1], y[j]}, dd[2] = {d[j - 1], d[j]};
            double photo = exp(skg_spline_value(skg_knots[i].log_energy, x[j - 1], x[j], yy, dd));
            double kev = skg_knots[i].energy_kev, error = fabs(photo - exp(skg_knots[i].value[SKG_PHOTO]));
            if (error / total(z, kev) > worst) worst = error / total(z, kev), worst_z = z, worst_kev = kev;
        }
    }
    /* Splines err as the fourth power of the step, which is doubled here. */
    printf("leave-one-out: worst %.2e of the total at Z %d, %g keV\n", worst, worst_z, worst_kev);
    ck_assert_double_le(worst, 0.021);
}
END_TEST

START_TEST(at_an_edge_the_value_above_counts) {
    double edge = 0; /* K of iodine */
    for (int32_t i = skg_elements[53].first + 1; i < skg_elements[53].last; i++)
        if (!(skg_knots[i].energy_kev > skg_knots[i - 1].energy_kev)) edge = skg_knots[i].energy_kev;
    /* keV: the last digit in print. */
    ck_assert_double_eq_tol(edge, 33.169, 1e-3);
    /* 1e-12 of the energy away, where the slope is below 4 decades a decade. */
    ck_assert_double_eq_tol(total(53, edge), total(53, edge * (1 + 1e-12)),
                            5e4 * DBL_EPSILON * total(53, edge));
    ck_assert_double_gt(total(53, edge), 5 * total(53, edge * (1 - 1e-12)));
}
END_TEST

START_TEST(pairs_begin_at_their_threshold) {
    double s[SKG_PROCESSES], before = 0;
    skg_element_sections(82, 1021.99, s);
    ck_assert_double_eq(s[SKG_PAIR], 0);
    for (double e = 1022; e < 20000; e *= 1.01) { /* rises all the way in lead */
        skg_element_sections(82, e, s);
        ck_assert_double_ge(s[SKG_PAIR], before);
        before = s[SKG_PAIR];
    }
}
END_TEST

START_TEST(energies_outside_are_refused) {
    skg_material *iron = NULL;
    double mu;
    ck_skg(skg_material_create_element(26, &iron));
    ck_skg_fails(skg_material_attenuation_get(iron, 0.99, &mu), SKG_ERR_MATERIAL, "outside");
    ck_skg_fails(skg_material_attenuation_get(iron, 20001, &mu), SKG_ERR_MATERIAL, "1 to 20000 keV");
    ck_skg_fails(skg_material_attenuation_get(iron, (double)NAN, &mu), SKG_ERR_MATERIAL, "outside");
    ck_skg(skg_material_attenuation_get(iron, 1, &mu));
    ck_skg(skg_material_attenuation_get(iron, 20000, &mu));
    skg_material_release(&iron);
}
END_TEST

/* Materials of every kind, whose elements a table works out once, against one energy at a time. */
START_TEST(tables_of_materials_have_the_bits_of_single_energies) {
    static const double energies[] = {1, 20, 33.17, 88.01, 1500}, tabled[] = {1, 100, 2000},
                        mu[] = {5, 1, 0.1};
    enum { MATERIALS = 5, COUNT = sizeof energies / sizeof *energies };
    skg_section_table table = {.count = COUNT, .energy_kev = energies};
    skg_material *materials[MATERIALS] = {0};
    ck_skg(skg_material_create_element(53, &materials[0]));
    ck_skg(skg_material_create_formula("CsI", 4.51, &materials[1]));
    ck_skg(skg_material_create_hounsfield(300, &materials[2]));
    ck_skg(skg_material_create_mu("grey", 0.3, &materials[3]));
    ck_skg(skg_material_create_table("rows", 3, tabled, mu, &materials[4]));
    for (int m = 0; m < MATERIALS; m++) {
        double found[COUNT];
        ck_skg(skg_attenuation_tabulate(materials[m], &table, found));
        for (int n = 0; n < COUNT; n++) {
            double single = 0;
            ck_skg(skg_material_attenuation_get(materials[m], energies[n], &single));
            ck_assert_mem_eq(&found[n], &single, sizeof single);
        }
    }
    for (int m = 0; m < MATERIALS; m++) skg_material_release(&materials[m]);
    skg_section_table_release(&table);
}
END_TEST

START_TEST(tables_of_materials_fail_as_single_energies) {
    static const double energies[] = {50, 20001}, low = 50;
    skg_section_table table = {.count = 2, .energy_kev = energies}, one = {.count = 1, .energy_kev = &low};
    skg_material *iron = NULL, *unknown = NULL;
    double found[2];
    ck_skg(skg_material_create_element(26, &iron));
    ck_skg(skg_material_create_formula("FeO", 0, &unknown));
    ck_skg_fails(skg_attenuation_tabulate(iron, &table, found), SKG_ERR_MATERIAL, "1 to 20000 keV");
    ck_skg_fails(skg_attenuation_tabulate(unknown, &one, found), SKG_ERR_MATERIAL, "density");
    skg_section_table_release(&table);
    skg_section_table_release(&one);
    skg_material_release(&iron);
    skg_material_release(&unknown);
}
END_TEST

enum { THREADS = 8, ENERGIES = 500 };

static void *look_up(void *place) {
    double *out = place;
    skg_material *bone = NULL;
    if (skg_material_create_named("Bone, cortical (ICRU-44)", &bone) != SKG_OK) return NULL;
    for (int i = 0; i < ENERGIES; i++)
        if (skg_material_attenuation_get(bone, 5 + 0.7 * i, &out[i]) != SKG_OK) return NULL;
    skg_material *none = NULL; /* errors meanwhile */
    if (skg_material_create_named("Unobtainium", &none) != SKG_ERR_MATERIAL) out[0] = 0;
    skg_material_release(&bone);
    return place;
}

START_TEST(threads_get_the_same_bits) {
    static double results[THREADS][ENERGIES];
    pthread_t threads[THREADS];
    for (int t = 0; t < THREADS; t++)
        ck_assert_int_eq(pthread_create(&threads[t], NULL, look_up, results[t]), 0);
    for (int t = 0; t < THREADS; t++) {
        void *done = NULL;
        pthread_join(threads[t], &done);
        ck_assert_ptr_nonnull(done);
        ck_assert_mem_eq(results[t], results[0], sizeof results[0]);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, grid_energies_give_the_table);
    tcase_add_test(tests, points_left_out_are_found_again);
    tcase_add_test(tests, at_an_edge_the_value_above_counts);
    tcase_add_test(tests, pairs_begin_at_their_threshold);
    tcase_add_test(tests, energies_outside_are_refused);
    tcase_add_test(tests, tables_of_materials_have_the_bits_of_single_energies);
    tcase_add_test(tests, tables_of_materials_fail_as_single_energies);
    tcase_add_test(tests, threads_get_the_same_bits);
}

SKG_SUITE_MAIN("element", add_tests)
