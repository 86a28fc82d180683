/* Fluorescence of the parts, against quadrature of the lines of a sheet before the detector. */
#include "material/material.h"
#include "material/shells.h"
#include "subject.h"
#include "suite.h"
#include "support/named.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* A sheet GAP mm before a detector of SIDE mm, in a beam that is parallel within 4 degrees. */
static const double FAR = 1000, GAP = 20, SIDE = 100;

static double per_mm(skg_material *material, double kev) {
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
    return per_cm / 10;
}

/* The share of photons from a depth, of the field's even illumination, that arrive on the field: both squares of SIDE mm. mu: 1/mm;
 * left: mm of the sheet before them */
static double arriving(double mu, double left) {
    enum { POLAR = 200, AZIMUTH = 32 };
    double sum = 0;
    for (int p = 0; p < POLAR; p++) {
        const double cosine = (p + 0.5) / POLAR, across = (GAP + left) * sqrt(1 - cosine * cosine) / cosine;
        double inside = 0;
        for (int a = 0; a < AZIMUTH; a++) {
            const double phi = 0.5 * PI * (a + 0.5) / AZIMUTH;
            inside += fmax(1 - across * cos(phi) / SIDE, 0) * fmax(1 - across * sin(phi) / SIDE, 0) / AZIMUTH;
        }
        sum += 0.5 / POLAR * exp(-mu * left / cosine) * inside;
    }
    return sum;
}

/* Photons per vacancy and their energies: keV that arrive per photon of the beam. */
static double of_shell(skg_material *material, double mm, double kev, const skg_shell *shell,
                       double per_photo) {
    enum { DEPTHS = 400 };
    const skg_shell_row *row = shell->row;
    const double mu = per_mm(material, kev);
    double sections[SKG_PROCESSES], sum = 0;
    skg_element_sections(row->z, kev, sections);
    const double made = sections[SKG_PHOTO] * material->density / 10 * per_photo;
    for (int l = 0; l < SKG_L_LINES; l++) {
        if (!(row->share[l] > 0)) continue;
        const double own = per_mm(material, row->line_kev[l]);
        for (int d = 0; d < DEPTHS; d++) {
            const double left = mm * pow((d + 0.5) / DEPTHS, 3),
                         step = mm * 3 * pow((d + 0.5) / DEPTHS, 2) / DEPTHS;
            sum += row->line_kev[l] * row->yield * row->share[l] * made * step * exp(-mu * (mm - left)) *
                   arriving(own, left);
        }
    }
    return sum;
}

/* keV that the lines of a sheet of one element bring, per photon of the beam. */
static double expected(skg_material *material, int32_t z, double mm, double kev) {
    skg_shell k, l;
    double sum = 0, alpha = 0;
    if (skg_shell_find(z, SKG_SHELL_K, &k) && kev > k.edge_kev[0]) {
        sum += of_shell(material, mm, kev, &k, skg_shell_vacancies(&k, kev));
        alpha = k.row->yield * (k.row->share[0] + k.row->share[1]) * skg_shell_vacancies(&k, kev);
    }
    if (skg_shell_find(z, SKG_SHELL_L, &l))
        sum += of_shell(material, mm, kev, &l, skg_shell_vacancies(&l, kev) + alpha);
    return sum;
}

/* What one interaction sends through the sheet, keV per photon of the beam. */
static double found(const char *name, double mm, double kev, int32_t fluorescence) {
    subject s;
    subject_open(&s);
    s.view.source[2] = -FAR, s.view.centre[2] = 0.5 * mm + GAP;
    s.view.columns = s.view.rows = 32;
    s.view.column_step[0] = s.view.row_step[1] = SIDE / 32;
    s.kev = kev, s.photons = 1;
    s.scatter.histories = 1 << 19;
    s.scatter.fluorescence = fluorescence;
    subject_add_box(&s, 3 * SIDE, 3 * SIDE, mm, name);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const double sum = subject_sum(&s, p.scatter) / (32 * 32) * subject_report(&s).orders[0];
    pictures_free(&p);
    subject_close(&s);
    return sum;
}

static const struct {
    const char *name;
    int32_t z;
    double mm, kev;
} sheets[] = {{"Pb", 82, 0.1, 100},
              {"W", 74, 0.2, 100},
              {"Ba", 56, 0.5, 60},
              {"Sn", 50, 0.1, 40},
              {"Pb", 82, 0.005, 30}};

START_TEST(sheets_emit_their_lines) {
    skg_material *material = named(sheets[_i].name);
    const double lines = expected(material, sheets[_i].z, sheets[_i].mm, sheets[_i].kev);
    const double with = found(sheets[_i].name, sheets[_i].mm, sheets[_i].kev, SKG_FLUORESCENCE_AUTO),
                 without = found(sheets[_i].name, sheets[_i].mm, sheets[_i].kev, SKG_FLUORESCENCE_OFF);
    /* Noise of 1 % in the sheets whose lines leave the last hundredth of a mm alone; 3 of these. */
    ck_assert_double_eq_tol((with - without) / lines, 1, 0.03);
    skg_material_release(&material);
}
END_TEST

/* Below every edge from Z = 30 on nothing is emitted, and light elements only on request. */
START_TEST(light_elements_are_left_out) {
    ck_assert_double_eq(found("Al", 5, 60, SKG_FLUORESCENCE_AUTO), found("Al", 5, 60, SKG_FLUORESCENCE_OFF));
    ck_assert_double_eq(found("Fe", 0.1, 60, SKG_FLUORESCENCE_AUTO),
                        found("Fe", 0.1, 60, SKG_FLUORESCENCE_OFF));
    ck_assert_double_gt(found("Fe", 0.01, 20, SKG_FLUORESCENCE_ON),
                        1.5 * found("Fe", 0.01, 20, SKG_FLUORESCENCE_OFF));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, sheets_emit_their_lines, 0, sizeof sheets / sizeof *sheets);
    tcase_add_test(tests, light_elements_are_left_out);
}

SKG_SUITE_MAIN("scatter/fluorescence", add_tests)
