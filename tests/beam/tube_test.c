/* Tube spectra against published tables, and each other. */
#include <skiagraph/beam.h>

#include "beam/spectrum.h"
#include "beam/tube.h"
#include "material/material.h"
#include "material/shells.h"
#include "suite.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* IEC 61267: RQR qualities are defined by their first half-value layer; the homogeneity follows. Aluminium is
 * added until the layer is right. */
START_TEST(homogeneity_of_rqr) {
    static const struct {
        double kv, hvl, homogeneity;
    } rqr[] = {{40, 1.42, .81}, {50, 1.78, .76},  {60, 2.19, .74},  {70, 2.58, .71}, {80, 3.01, .69},
               {90, 3.48, .68}, {100, 3.97, .68}, {120, 5.00, .68}, {150, 6.57, .72}};
    for (size_t i = 0; i < sizeof rqr / sizeof *rqr; i++) {
        double low = 0.5, high = 8;
        skg_quality q;
        do {
            layer layers[] = {{"Al", (low + high) / 2}, {NULL, 0}};
            q = quality(SKG_TUBE_MODEL_EBEL, rqr[i].kv, 12, layers);
            if (q.hvl1_mm_al < rqr[i].hvl)
                low = (low + high) / 2;
            else
                high = (low + high) / 2;
        } while (high - low > 1e-3);
        if (getenv("SKG_LIST"))
            printf("%g kV: %.2f mm Al, homogeneity %.3f (%.2f)\n", rqr[i].kv, low, q.homogeneity,
                   rqr[i].homogeneity);
        /* The standard prints two digits, half a unit of which is 0.005; the rest is what the model reaches. */
        ck_assert_msg(fabs(q.homogeneity - rqr[i].homogeneity) <= 0.02, "%g kV: homogeneity %.3f", rqr[i].kv,
                      q.homogeneity);
    }
}
END_TEST

/* Air kerma and half-value layer of SpekPy 2.5, W, 12 degrees, 2.5 mm Al, at 1 m. */
START_TEST(output_per_mas) {
    static const struct {
        double kv, vacuum, air, hvl;
    } rows[] = {{60, 48.9, 46.5, 2.082},
                {80, 82.0, 78.4, 2.734},
                {100, 118.9, 114.3, 3.458},
                {120, 158.7, 153.1, 4.219},
                {150, 222.8, 215.8, 5.372}};
    static const layer vacuum[] = {{"Al", 2.5}, {NULL, 0}}, air[] = {{"Al", 2.5}, {"Air", 1000}, {NULL, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int32_t model = SKG_TUBE_MODEL_EBEL; model <= SKG_TUBE_MODEL_BIRCH; model++) {
            const skg_quality q = quality(model, rows[i].kv, 12, vacuum);
            double v = q.air_kerma_ugy, a = quality(model, rows[i].kv, 12, air).air_kerma_ugy;
            if (getenv("SKG_LIST"))
                printf("model %d, %g kV: %.1f and %.1f uGy/mAs, HVL1 %.3f mm Al\n", model, rows[i].kv, v, a,
                       q.hvl1_mm_al);
            /* The aim of the calibration; the programs have cross sections of their own. */
            ck_assert_msg(fabs(v / rows[i].vacuum - 1) <= 0.02, "%g kV: %.1f uGy/mAs", rows[i].kv, v);
            ck_assert_msg(fabs(a / rows[i].air - 1) <= 0.02, "%g kV, air: %.1f uGy/mAs", rows[i].kv, a);
            /* as above */
            ck_assert_msg(fabs(q.hvl1_mm_al / rows[i].hvl - 1) <= 0.01, "%g kV: HVL1 %.3f mm", rows[i].kv,
                          q.hvl1_mm_al);
        }
}
END_TEST

/* SpekPy 2.5.4, W at 1 m in vacuum: industrial voltages. */
START_TEST(industrial_beams) {
    static const struct {
        double kv, angle;
        const char *filter;
        double mm, kerma, hvl_al, hvl_cu;
    } rows[] = {{160, 12, "Al", 2.5, 245.86, 5.7665, 0.27207}, {160, 12, "Cu", 0.5, 108.38, 11.068, 0.81605},
                {160, 12, "Cu", 2, 36.408, 14.482, 1.5741},    {160, 20, "Al", 2.5, 278.74, 5.1868, 0.23143},
                {160, 20, "Cu", 0.5, 113.61, 10.891, 0.78519}, {160, 20, "Cu", 2, 36.969, 14.36, 1.5336},
                {200, 12, "Al", 2.5, 344.07, 7.2933, 0.41713}, {200, 12, "Cu", 0.5, 184.93, 12.385, 1.0994},
                {200, 12, "Cu", 2, 77.703, 15.825, 2.0886},    {200, 20, "Al", 2.5, 393.27, 6.5273, 0.34565},
                {200, 20, "Cu", 0.5, 195.66, 12.119, 1.0372},  {200, 20, "Cu", 2, 79.238, 15.66, 2.0199},
                {250, 12, "Al", 2.5, 484.17, 9.085, 0.65223},  {250, 12, "Cu", 0.5, 305.22, 13.773, 1.4924},
                {250, 12, "Cu", 2, 152.23, 17.129, 2.6801},    {250, 20, "Al", 2.5, 555.19, 8.131, 0.52871},
                {250, 20, "Cu", 0.5, 325.26, 13.397, 1.3759},  {250, 20, "Cu", 2, 155.75, 16.914, 2.5756},
                {300, 12, "Al", 2.5, 644.24, 10.701, 0.94305}, {300, 12, "Cu", 0.5, 451.01, 14.971, 1.9166},
                {300, 12, "Cu", 2, 251.49, 18.189, 3.2064},    {300, 20, "Al", 2.5, 738.09, 9.6012, 0.75125},
                {300, 20, "Cu", 0.5, 482.54, 14.491, 1.7353},  {300, 20, "Cu", 2, 257.82, 17.929, 3.0692}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int32_t model = SKG_TUBE_MODEL_EBEL; model <= SKG_TUBE_MODEL_BIRCH; model++) {
            const layer layers[] = {{rows[i].filter, rows[i].mm}, {NULL, 0}};
            const skg_quality q = quality(model, rows[i].kv, rows[i].angle, layers);
            const double kerma = q.air_kerma_ugy / rows[i].kerma - 1, al = q.hvl1_mm_al / rows[i].hvl_al - 1,
                         cu = q.hvl1_mm_cu / rows[i].hvl_cu - 1;
            /* The aim of the calibration; at 20 degrees its output is 2 to 3 % high, also at 150 kV. */
            ck_assert_msg(
                fabs(kerma) <= (rows[i].angle > 12 ? 0.035 : 0.02) && fabs(al) <= 0.015 && fabs(cu) <= 0.016,
                "model %d, %g kV, %g degrees, %g mm %s: kerma %+.1f %%, HVL1 %+.1f %% Al, %+.1f %% Cu",
                (int)model, rows[i].kv, rows[i].angle, rows[i].mm, rows[i].filter, 100 * kerma, 100 * al,
                100 * cu);
        }
}
END_TEST

/* SpekPy 2.5.4 at 12 degrees and 1 m, in vacuum: thin filters, where L lines count, and mammography. */
START_TEST(soft_beams) {
    static const struct {
        int32_t anode;
        const char *filter;
        double mm, kv, kerma, hvl;
    } rows[] = {
        {74, "Al", 0.5, 25, 52.63, 0.2684},   {74, "Al", 0.5, 30, 78.76, 0.3211},
        {74, "Al", 0.5, 35, 104.04, 0.3696},  {74, "Al", 0.5, 40, 127.70, 0.4155},
        {42, "Mo", 0.03, 25, 45.44, 0.2540},  {42, "Mo", 0.03, 28, 62.70, 0.2861},
        {42, "Mo", 0.03, 32, 88.51, 0.3208},  {42, "Mo", 0.03, 35, 108.63, 0.3408},
        {42, "Rh", 0.025, 25, 35.88, 0.3055}, {42, "Rh", 0.025, 28, 51.17, 0.3424},
        {42, "Rh", 0.025, 32, 73.82, 0.3771}, {42, "Rh", 0.025, 35, 91.42, 0.3958},
        {45, "Rh", 0.025, 25, 33.13, 0.2879}, {45, "Rh", 0.025, 28, 45.20, 0.3283},
        {45, "Rh", 0.025, 32, 63.90, 0.3800}, {45, "Rh", 0.025, 35, 78.38, 0.4113},
        {74, "Rh", 0.05, 25, 15.52, 0.4343},  {74, "Rh", 0.05, 28, 20.27, 0.4646},
        {74, "Rh", 0.05, 32, 25.97, 0.4942},  {74, "Rh", 0.05, 35, 30.01, 0.5155},
        {74, "Ag", 0.05, 25, 17.26, 0.4378},  {74, "Ag", 0.05, 28, 23.89, 0.4952},
        {74, "Ag", 0.05, 32, 31.57, 0.5405},  {74, "Ag", 0.05, 35, 36.92, 0.5686},
    };
    const size_t count = sizeof rows / sizeof *rows;
    for (size_t n = 0; n < 2 * count; n++) {
        const size_t i = n % count;
        const int32_t model = n < count ? SKG_TUBE_MODEL_EBEL : SKG_TUBE_MODEL_BIRCH;
        const int is_thin = strcmp(rows[i].filter, "Al") == 0;
        /* Mammography tubes have a window of 1 mm Be. */
        const layer layers[] = {{rows[i].filter, rows[i].mm}, {"Be", is_thin ? 0 : 1}, {NULL, 0}};
        const skg_quality q = quality_of(rows[i].anode, model, rows[i].kv, 12, layers);
        const double kerma = q.air_kerma_ugy / rows[i].kerma - 1, hvl = q.hvl1_mm_al / rows[i].hvl - 1;
        if (getenv("SKG_LIST"))
            printf("model %d, Z %d, %g mm %s, %g kV: kerma %+.1f %%, HVL1 %+.1f %%\n", model, rows[i].anode,
                   rows[i].mm, rows[i].filter, rows[i].kv, 100 * kerma, 100 * hvl);
        /* The accuracy of the calibration, and half as much again: L lines pass 0.5 mm Al, and are attenuated by cross
         * sections of which the programs differ. */
        ck_assert_msg(fabs(hvl) <= (is_thin ? 0.05 : 0.02), "%g kV, %s: HVL1 %+.1f %%", rows[i].kv,
                      rows[i].filter, 100 * hvl);
        ck_assert_msg(fabs(kerma) <= (is_thin ? 0.05 : 0.02), "%g kV, %s: kerma %+.1f %%", rows[i].kv,
                      rows[i].filter, 100 * kerma);
    }
}
END_TEST

/* Photons of the K lines behind 2.5 mm Al at 1 m, W, 12 degrees. */
static double k_line_photons(double kv) {
    const skg_anode anode = {74, kv, 12};
    skg_material *al = named("Al");
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = al, .thickness_mm = 2.5};
    double sum = 0;
    for (int k = 0; k < SKG_K_LINES; k++) {
        double kev = 0, passed = 0;
        const double photons = skg_tube_line(skg_tube_calibration_of(74), &anode, SKG_SHELL_K, k, &kev);
        if (!(photons > 0)) continue;
        ck_skg(skg_filters_pass(1, &filter, kev, &passed));
        sum += photons * passed;
    }
    skg_material_release(&al);
    return sum;
}

/* SpekPy 2.5, W, 12 degrees, 2.5 mm Al. */
START_TEST(k_lines_share) {
    static const double rows[][2] = {{80, .016}, {100, .057}, {120, .087}, {150, .112}};
    static const layer layers[] = {{"Al", 2.5}, {NULL, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double share =
            k_line_photons(rows[i][0]) / quality(SKG_TUBE_MODEL_EBEL, rows[i][0], 12, layers).photons;
        if (getenv("SKG_LIST")) printf("%g kV: K lines %.2f %%\n", rows[i][0], 100 * share);
        /* Half of a percent point: what the calibration is asked to reach. */
        ck_assert_msg(fabs(share - rows[i][1]) <= 0.005, "%g kV: lines %.2f %%", rows[i][0], 100 * share);
    }
}
END_TEST

/* The paper's Fig. 4: 90 kV behind twice 5 mm of copper, "80 keV". */
START_TEST(beam_of_figure_4) {
    static const layer layers[] = {{"Cu", 5}, {"Cu", 5}, {NULL, 0}};
    double mean = quality(SKG_TUBE_MODEL_EBEL, 90, 12, layers).mean_kev,
           birch = quality(SKG_TUBE_MODEL_BIRCH, 90, 12, layers).mean_kev;
    if (getenv("SKG_LIST")) printf("Fig. 4: %.2f keV (Ebel), %.2f keV (Birch)\n", mean, birch);
    ck_assert(mean > 80 && mean < 83);
    ck_assert(birch > 80 && birch < 83);
}
END_TEST

START_TEST(output_scales) {
    skg_tube t;
    skg_filter filter = {.size = (int32_t)sizeof filter, .thickness_mm = 2.5};
    skg_material *al = named("Al");
    skg_spectrum *s = NULL;
    skg_quality one, other;
    filter.material = al;
    skg_quality_init(&one);
    skg_quality_init(&other);
    skg_tube_init(&t);
    t.kvp = 85;
    t.filters = &filter;
    t.filter_count = 1;
    ck_skg(skg_spectrum_create_tube(&t, &s));
    ck_skg(skg_spectrum_quality_get(s, &one));
    skg_spectrum_release(&s);
    t.mas = 4, t.distance_mm = 2000, t.pixel_mm2 = 0.25; /* 4 / 4 / 4 */
    ck_skg(skg_spectrum_create_tube(&t, &s));
    ck_skg(skg_spectrum_quality_get(s, &other));
    skg_spectrum_release(&s);
    ck_assert_double_eq_tol(other.photons / one.photons, 0.25, 64 * DBL_EPSILON);
    t.mas = 1, t.distance_mm = 1000, t.pixel_mm2 = 1;
    t.output_ugy_mas = 65; /* at 1 m */
    ck_skg(skg_spectrum_create_tube(&t, &s));
    ck_skg(skg_spectrum_quality_get(s, &other));
    skg_spectrum_release(&s);
    ck_assert_double_eq_tol(other.air_kerma_ugy, 65, 64 * DBL_EPSILON * 65);
    t.output_ugy_mas = 0, t.bin_kev = 0.5; /* bins of another width: the same beam */
    ck_skg(skg_spectrum_create_tube(&t, &s));
    ck_skg(skg_spectrum_quality_get(s, &other));
    skg_spectrum_release(&s);
    /* One spectrum in bins half as wide: the sums differ by 1.3e-4. */
    ck_assert_double_eq_tol(other.air_kerma_ugy / one.air_kerma_ugy, 1, 5e-3);
    skg_material_release(&al);
}
END_TEST

/* The heel effect of SpekPy 2.5.4: W, 12 degrees, 100 kV, 2.5 mm Al crossed straight, in a plane at 1 m. x towards the
 * cathode, cm; its kerma has the inverse square of the distance. */
START_TEST(heel_of_a_tube) {
    static const double rows[][3] = {{-15, 75.276, 4.491}, {-10, 97.427, 3.930}, {-5, 110.569, 3.639},
                                     {5, 124.139, 3.335},  {10, 127.117, 3.245}, {15, 128.362, 3.178}};
    static const layer layers[] = {{"Al", 2.5}, {NULL, 0}};
    const double centre = quality(SKG_TUBE_MODEL_EBEL, 100, 12, layers).air_kerma_ugy;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double x = rows[i][0] / 100, angle = 12 + atan(x) * (180 / acos(-1));
        const skg_quality q = quality(SKG_TUBE_MODEL_EBEL, 100, angle, layers);
        const double kerma = q.air_kerma_ugy / centre / (rows[i][1] * (1 + x * x) / 118.911) - 1;
        const double hvl = q.hvl1_mm_al / rows[i][2] - 1;
        if (getenv("SKG_LIST"))
            printf("%g cm: kerma %+.1f %%, HVL1 %+.1f %%\n", rows[i][0], 100 * kerma, 100 * hvl);
        /* The accuracy of the calibration at 3.5 to 20.5 degrees, and half as much again. */
        ck_assert_msg(fabs(kerma) <= 0.02 && fabs(hvl) <= 0.02, "%g cm: kerma %+.1f %%, HVL1 %+.1f %%",
                      rows[i][0], 100 * kerma, 100 * hvl);
    }
}
END_TEST

static char warned[1024];

static void keep(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING) strncat(warned, sentence, sizeof warned - strlen(warned) - 1);
}

/* Tubes outside the range of the validation are warned of, and others are not. */
START_TEST(limits_are_warned_of) {
    static const struct {
        int32_t anode;
        double kv, angle, mm_al;
        const char *warning; /* NULL: none */
    } rows[] = {
        {74, 60, 12, 2.5, NULL},
        {74, 25, 12, 0.5, NULL},
        {74, 25, 12, 0.05, "below 7 keV"},
        {74, 19, 12, 1, "validated from 20 to 300 kV"},
        {74, 160, 12, 4, NULL},
        {74, 320, 12, 4,
         "validated from 20 to 300 kV only, with an anode of W; output and half-value layers change from there as by another "
         "computation (xpecgen)"},
        {74, 420, 12, 4,
         "validated from 20 to 300 kV only, with an anode of W; output and half-value layers are not verified"},
        {74, 60, 5, 2.5, "validated from 6 to 20 degrees"},
        {74, 60, 25, 2.5, "validated from 6 to 20 degrees"},
        {42, 30, 12, 0.5, NULL},
        {45, 30, 20, 0.5, NULL},
        {42, 60, 12, 0.5, "validated from 20 to 49 kV only, with an anode of Mo"},
        {42, 30, 8, 0.5, "validated from 12 to 20 degrees"},
        {29, 30, 12, 0.5, "validated for W, Mo and Rh only"},
        {74, 80, 12, 1.5, "IEC 60601-1-3"},
    };
    skg_material *al = named("Al");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        skg_tube t;
        skg_spectrum *s = NULL;
        const skg_filter filter = {
            .size = (int32_t)sizeof filter, .material = al, .thickness_mm = rows[i].mm_al};
        skg_tube_init(&t);
        t.anode = rows[i].anode, t.kvp = rows[i].kv, t.angle_deg = rows[i].angle;
        t.filters = &filter, t.filter_count = 1, t.log = keep;
        *warned = '\0';
        ck_skg(skg_spectrum_create_tube(&t, &s));
        if (rows[i].warning)
            ck_assert_msg(strstr(warned, rows[i].warning), "row %d: %s", (int)i, warned);
        else
            ck_assert_str_eq(warned, "");
        skg_spectrum_release(&s);
    }
    skg_material_release(&al);
}
END_TEST

/* How beams of tungsten at 12 degrees change from 300 kV in xpecgen 1.3.1 (bench/validate/beyond.py), whose electrons follow simulations by
 * FLUKA: air kerma and first half-value layers in Al and Cu, behind 2.5 mm of aluminium and some copper. */
START_TEST(changes_from_300_kv) {
    static const struct {
        double kv, mm_cu, kerma, hvl_al, hvl_cu;
    } rows[] = {{350, 0, 1.294, 1.143, 1.400},   {400, 0, 1.631, 1.268, 1.821},
                {350, 0.5, 1.403, 1.069, 1.213}, {400, 0.5, 1.875, 1.130, 1.407},
                {350, 2, 1.504, 1.049, 1.139},   {400, 2, 2.111, 1.092, 1.260},
                {350, 8, 1.693, 1.041, 1.104},   {400, 8, 2.584, 1.078, 1.192}};
    const int32_t model = _i ? SKG_TUBE_MODEL_BIRCH : SKG_TUBE_MODEL_EBEL;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const layer layers[] = {{"Al", 2.5}, {rows[i].mm_cu > 0 ? "Cu" : NULL, rows[i].mm_cu}, {NULL, 0}};
        const skg_quality here = quality(model, rows[i].kv, 12, layers),
                          seam = quality(model, 300, 12, layers);
        const double kerma = here.air_kerma_ugy / seam.air_kerma_ugy / rows[i].kerma - 1;
        const double al = here.hvl1_mm_al / seam.hvl1_mm_al / rows[i].hvl_al - 1;
        const double cu = here.hvl1_mm_cu / seam.hvl1_mm_cu / rows[i].hvl_cu - 1;
        if (getenv("SKG_LIST"))
            printf("%g kV, %g mm Cu: kerma %+.1f %%, HVL1 %+.1f %% in Al, %+.1f %% in Cu\n", rows[i].kv,
                   rows[i].mm_cu, 100 * kerma, 100 * al, 100 * cu);
        /* The four factors of the fit reach 2.5, 0.5 and 3.3 %: a fifth more. */
        ck_assert_msg(fabs(kerma) <= 0.03 && fabs(al) <= 0.008 && fabs(cu) <= 0.04,
                      "%g kV, %g mm Cu: kerma %+.1f %%, HVL1 %+.1f %% in Al, %+.1f %% in Cu", rows[i].kv,
                      rows[i].mm_cu, 100 * kerma, 100 * al, 100 * cu);
    }
}
END_TEST

/* Calibrations end where they were fitted: spectra change steadily beyond, and never become negative. */
START_TEST(beyond_the_calibration) {
    static const layer layers[] = {{"Al", 3}, {NULL, 0}};
    double before = 0;
    const int32_t model = _i ? SKG_TUBE_MODEL_BIRCH : SKG_TUBE_MODEL_EBEL;
    for (double kv = 12; kv <= 450; kv += kv < 30 ? 1 : 10) {
        const double kerma = quality(model, kv, 12, layers).air_kerma_ugy;
        ck_assert_msg(kerma > before, "%g kV: %g after %g", kv, kerma, before);
        before = kerma;
    }
}
END_TEST

START_TEST(tubes_that_cannot_be) {
    skg_tube t;
    skg_spectrum *s = NULL;
    skg_filter none = {.size = (int32_t)sizeof none, .thickness_mm = 1};
    skg_tube_init(&t);
    ck_skg_fails(skg_spectrum_create_tube(&t, &s), SKG_ERR_BEAM, "tube voltage of 0 kV");
    t.kvp = 90, t.angle_deg = 0;
    ck_skg_fails(skg_spectrum_create_tube(&t, &s), SKG_ERR_BEAM, "angle");
    t.angle_deg = 12, t.anode = 6;
    ck_skg_fails(skg_spectrum_create_tube(&t, &s), SKG_ERR_BEAM, "anode of C");
    t.anode = 74, t.filters = &none, t.filter_count = 1;
    ck_skg_fails(skg_spectrum_create_tube(&t, &s), SKG_ERR_BEAM, "filter 1 has no material");
    t.filter_count = 0, t.model = 7;
    ck_skg_fails(skg_spectrum_create_tube(&t, &s), SKG_ERR_BEAM, "model 7");
    t.model = 0, t.mas = -1;
    ck_skg_fails(skg_spectrum_create_tube(&t, &s), SKG_ERR_BEAM, "tube load");
    ck_assert_ptr_null(s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, homogeneity_of_rqr);
    tcase_add_test(tests, output_per_mas);
    tcase_add_test(tests, industrial_beams);
    tcase_add_test(tests, soft_beams);
    tcase_add_test(tests, k_lines_share);
    tcase_add_test(tests, heel_of_a_tube);
    tcase_add_test(tests, limits_are_warned_of);
    tcase_add_loop_test(tests, changes_from_300_kv, 0, 2);
    tcase_add_loop_test(tests, beyond_the_calibration, 0, 2);
    tcase_add_test(tests, beam_of_figure_4);
    tcase_add_test(tests, output_scales);
    tcase_add_test(tests, tubes_that_cannot_be);
}

SKG_SUITE_MAIN("tube", add_tests)
