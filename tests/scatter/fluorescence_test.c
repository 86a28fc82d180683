/* Photons that the parts emit, fluorescence and annihilation, against quadrature of the lines of a sheet before the detector. */
#include "material/material.h"
#include "material/shells.h"
#include "subject.h"
#include "suite.h"
#include "support/named.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* The electron's at rest. */
#define REST_KEV 510.99895

/* A sheet GAP mm before a detector of SIDE mm, in a beam that is parallel within .4 degrees. */
static const double FAR = 10000, GAP = 20, SIDE = 100;

static double per_mm(skg_material *material, double kev) {
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
    return per_cm / 10;
}

/* The share of those from even places of a square of SIDE mm that meet another one `across` mm beside their own place, in any direction. */
static double meeting(double across) {
    enum { AZIMUTH = 32 };
    double inside = 0;
    for (int a = 0; a < AZIMUTH; a++) {
        const double phi = 0.5 * PI * (a + 0.5) / AZIMUTH;
        inside += fmax(1 - across * cos(phi) / SIDE, 0) * fmax(1 - across * sin(phi) / SIDE, 0) / AZIMUTH;
    }
    return inside;
}

/* The share of photons in a direction, by its cosine, from a depth, of the field's even illumination, that arrive on the field. mu: 1/mm;
 * left: mm of the sheet before them */
static double arriving_at(double cosine, double mu, double left) {
    return exp(-mu * left / cosine) * meeting((GAP + left) * sqrt(1 - cosine * cosine) / cosine);
}

/* The mean over photons in all directions. */
static double arriving(double mu, double left) {
    enum { POLAR = 200 };
    double sum = 0;
    for (int p = 0; p < POLAR; p++) sum += 0.5 / POLAR * arriving_at((p + 0.5) / POLAR, mu, left);
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

/* A sheet before a detector of 32 x 32 pixels. */
static subject open_sheet(const char *name, double mm, double kev) {
    subject s;
    subject_open(&s);
    s.view.source[2] = -FAR, s.view.centre[2] = 0.5 * mm + GAP;
    s.view.columns = s.view.rows = 32;
    s.view.column_step[0] = s.view.row_step[1] = SIDE / 32;
    s.kev = kev, s.photons = 1;
    s.scatter.histories = 1 << 19;
    subject_add_box(&s, 3 * SIDE, 3 * SIDE, mm, name);
    return s;
}

/* Energy that first interactions send through the sheet, keV per photon of the beam. */
static double found(const char *name, double mm, double kev, int32_t fluorescence) {
    subject s = open_sheet(name, mm, kev);
    s.scatter.fluorescence = fluorescence;
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
              {"Ba", 56, 0.5, 60},
              {"W", 74, 0.2, 100},
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

/* 1/mm of Compton scattering to 1 keV around the energy of annihilation, of free electrons (Klein and Nishina), as nearly all are there;
 * *cosine: of its angle. */
static double compton_to_annihilation(double kev, double per_mm3, double *cosine) {
    const double radius = 2.8179403262e-12, ratio = REST_KEV / kev; /* mm; of the energies */
    *cosine = ratio;
    const double square = 1 - *cosine * *cosine;
    return per_mm3 * 0.5 * radius * radius * ratio * ratio * (ratio + 1 / ratio - square) * 2 * PI / REST_KEV;
}

/* Of pairs in a sheet, by what arrives in a narrow band around 511 keV. */
START_TEST(pairs_send_photons_of_annihilation) {
    enum { DEPTHS = 400 };
    static const double edges[] = {REST_KEV - 0.5, REST_KEV + 0.5}, energies[] = {1250, 6000}, mm = 0.2;
    skg_material *lead = named("Pb");
    for (int k = 0; k < 2; k++) {
        subject s = open_sheet("Pb", mm, energies[k]);
        skg_coefficients c;
        skg_coefficients_init(&c);
        ck_skg(skg_material_coefficients_get(lead, energies[k], &c));
        const double mu = per_mm(lead, energies[k]), own = per_mm(lead, REST_KEV);
        double expected = 0, cosine;
        /* 11.35 g/cm3, 207.2 g/mol */
        const double compton =
            compton_to_annihilation(energies[k], 82 * 6.02214076e23 * 11.35e-3 / 207.2, &cosine);
        for (int d = 0; d < DEPTHS; d++) {
            const double left = mm * (d + 0.5) / DEPTHS;
            expected +=
                REST_KEV * mm / DEPTHS * exp(-mu * (mm - left)) *
                (2 * mu * c.pair / c.total * arriving(own, left) + compton * arriving_at(cosine, own, left));
        }
        s.options.bands = 1, s.options.band_kev = edges;
        subject_plan(&s);
        pictures p = subject_pictures(&s, NULL);
        const double sum = subject_sum(&s, p.scatter) / (32 * 32);
        printf("%g keV: %.4g keV around that of annihilation, %.4f of the closed form\n", energies[k], sum,
               sum / expected);
        fflush(stdout); /* before an assertion ends the process */
        /* Of 1.25 MeV few that interact make a pair or arrive in the band, so that their noise is 1.5 %. */
        ck_assert_double_eq_tol(sum / expected, 1, (k ? 0.015 : 0.04));
        pictures_free(&p);
        subject_close(&s);
    }
    skg_material_release(&lead);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, sheets_emit_their_lines, 0,
                        suite_turns(sizeof sheets / sizeof *sheets, 2)); /* K lines of two */
    tcase_add_test(tests, light_elements_are_left_out);
    tcase_add_test(tests, pairs_send_photons_of_annihilation);
}

SKG_SUITE_MAIN("scatter/fluorescence", add_tests)
