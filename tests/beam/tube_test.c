/* Tube spectra against measured half-value layers (PTB), published output, and each other. */
#include <skiagraph/beam.h>

#include "data.h"
#include "suite.h"

#include <math.h>
#include <string.h>

static skg_material *named(const char *text) {
    skg_material *material = NULL;
    ck_skg(skg_material_create_named(text, &material));
    return material;
}

enum { MOST_LAYERS = 8 };

/* A tube with layers given as material and mm pairs; NULL ends them. */
typedef struct {
    const char *material;
    double mm;
} layer;

static skg_spectrum *tube(int32_t model, double kvp, double angle, const layer *layers) {
    skg_tube t;
    skg_filter filters[MOST_LAYERS];
    skg_material *materials[MOST_LAYERS];
    skg_spectrum *spectrum = NULL;
    int count = 0;
    for (; layers && layers[count].material; count++) {
        materials[count] = named(layers[count].material);
        skg_filter_init(&filters[count]);
        filters[count].material = materials[count];
        filters[count].thickness_mm = layers[count].mm;
    }
    skg_tube_init(&t);
    t.model = model;
    t.kvp = kvp;
    t.angle_deg = angle;
    t.filters = filters;
    t.filter_count = count;
    ck_skg(skg_spectrum_create_tube(&t, &spectrum));
    while (count > 0) skg_material_release(&materials[--count]);
    return spectrum;
}

static skg_quality quality(int32_t model, double kvp, double angle, const layer *layers) {
    skg_quality q;
    skg_quality_init(&q);
    skg_spectrum *spectrum = tube(model, kvp, angle, layers);
    ck_skg(skg_spectrum_quality_get(spectrum, &q));
    skg_spectrum_release(&spectrum);
    return q;
}

typedef struct {
    double first, second, ratio;
    char first_at[32], second_at[32];
} worst;

static void note(double deviation, const char *name, double *most, char *at) {
    if (fabs(deviation) <= fabs(*most)) return;
    *most = deviation;
    snprintf(at, 32, "%s", name);
}

/* IEC qualities: RQR and RQA, half-value layers in mm Al. */
static void iec(int32_t model, const char *label, double first_bar, double second_bar, double ratio_bar) {
    FILE *file = open_data("physics/beam_qualities.csv");
    if (!file) return;
    char line[512];
    worst w = {0};
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        char name[16];
        double kv, be, al, hvl1, hvl2;
        if (sscanf(line, "%15[^,],%lf,%lf,%lf,%lf,%lf", name, &kv, &be, &al, &hvl1, &hvl2) != 6) continue;
        layer layers[] = {{"Kapton", 0.25}, {"Be", be}, {"Al", al}, {"Air", 950}, {NULL, 0}};
        skg_quality q = quality(model, kv, 20, layers);
        double d1 = q.hvl1_mm_al / hvl1 - 1, d2 = q.hvl2_mm_al / hvl2 - 1;
        if (getenv("SKG_LIST"))
            printf("%s %s: HVL1 %.3f (%+.1f %%), HVL2 %.3f (%+.1f %%), mean %.2f keV\n", label, name,
                   q.hvl1_mm_al, 100 * d1, q.hvl2_mm_al, 100 * d2, q.mean_kev);
        ck_assert_msg(fabs(d1) <= first_bar, "%s %s: HVL1 %+.1f %%", label, name, 100 * d1);
        ck_assert_msg(fabs(d2) <= second_bar, "%s %s: HVL2 %+.1f %%", label, name, 100 * d2);
        ck_assert_msg(fabs(q.homogeneity - hvl1 / hvl2) <= ratio_bar, "%s %s: homogeneity %.3f", label, name,
                      q.homogeneity - hvl1 / hvl2);
        note(100 * d1, name, &w.first, w.first_at);
        note(100 * d2, name, &w.second, w.second_at);
        rows++;
    }
    fclose(file);
    printf("%s: worst HVL1 %+.1f %% (%s), HVL2 %+.1f %% (%s)\n", label, w.first, w.first_at, w.second,
           w.second_at);
    ck_assert_int_eq(rows, 18);
}

START_TEST(ebel_agrees_with_ptb) {
    iec(SKG_TUBE_MODEL_EBEL, "Ebel", 0.06, 0.05, 0.025);
}
END_TEST

START_TEST(birch_agrees_with_ptb) {
    iec(SKG_TUBE_MODEL_BIRCH, "Birch", 0.07, 0.05, 0.025);
}
END_TEST

/* ISO 4037 qualities: half-value layers in mm Cu; nominal mean energies of the N series. */
START_TEST(iso_qualities) {
    FILE *file = open_data("physics/beam_qualities_iso_cu.csv");
    if (!file) return;
    char line[512];
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        static const struct {
            const char *name;
            double mean;
        } nominal[] = {{"N40", 33}, {"N60", 48}, {"N80", 65}, {"N100", 83}, {"N120", 100}};
        char name[16];
        double kv, be, al, cu, sn, pb, hvl1, hvl2;
        if (sscanf(line, "%15[^,],%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", name, &kv, &be, &al, &cu, &sn, &pb, &hvl1,
                   &hvl2) != 9)
            continue;
        layer layers[] = {{"Kapton", 0.25}, {"Be", be}, {"Al", al},   {"Cu", cu},
                          {"Sn", sn},       {"Pb", pb}, {"Air", 950}, {NULL, 0}};
        skg_quality q = quality(SKG_TUBE_MODEL_EBEL, kv, 20, layers);
        if (getenv("SKG_LIST"))
            printf("%s: HVL1 %+.1f %%, HVL2 %+.1f %%, mean %.2f keV\n", name, 100 * (q.hvl1_mm_cu / hvl1 - 1),
                   100 * (q.hvl2_mm_cu / hvl2 - 1), q.mean_kev);
        ck_assert_msg(fabs(q.hvl1_mm_cu / hvl1 - 1) <= 0.06, "%s: HVL1 %.4f mm Cu", name, q.hvl1_mm_cu);
        ck_assert_msg(fabs(q.hvl2_mm_cu / hvl2 - 1) <= 0.05, "%s: HVL2 %.4f mm Cu", name, q.hvl2_mm_cu);
        for (size_t i = 0; i < sizeof nominal / sizeof *nominal; i++)
            if (strcmp(nominal[i].name, name) == 0)
                ck_assert_msg(fabs(q.mean_kev - nominal[i].mean) <= 0.5, "%s: mean %.2f keV", name,
                              q.mean_kev);
        rows++;
    }
    fclose(file);
    ck_assert_int_eq(rows, 12);
}
END_TEST

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
        ck_assert_msg(fabs(q.homogeneity - rqr[i].homogeneity) <= 0.02, "%g kV: homogeneity %.3f", rqr[i].kv,
                      q.homogeneity);
    }
}
END_TEST

/* Air kerma and K lines of SpekPy 2.5, W, 12 degrees, 2.5 mm Al, at 1 m. */
START_TEST(output_per_mas) {
    static const struct {
        double kv, vacuum, air;
    } rows[] = {
        {60, 48.9, 46.5}, {80, 82.0, 78.4}, {100, 118.9, 114.3}, {120, 158.7, 153.1}, {150, 222.8, 215.8}};
    static const layer vacuum[] = {{"Al", 2.5}, {NULL, 0}}, air[] = {{"Al", 2.5}, {"Air", 1000}, {NULL, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int32_t model = SKG_TUBE_MODEL_EBEL; model <= SKG_TUBE_MODEL_BIRCH; model++) {
            double v = quality(model, rows[i].kv, 12, vacuum).air_kerma_ugy,
                   a = quality(model, rows[i].kv, 12, air).air_kerma_ugy;
            if (getenv("SKG_LIST"))
                printf("model %d, %g kV: %.1f and %.1f uGy/mAs\n", model, rows[i].kv, v, a);
            ck_assert_msg(fabs(v / rows[i].vacuum - 1) <= 0.05, "%g kV: %.1f uGy/mAs", rows[i].kv, v);
            ck_assert_msg(fabs(a / rows[i].air - 1) <= 0.05, "%g kV, air: %.1f uGy/mAs", rows[i].kv, a);
        }
}
END_TEST

/* Photons above a straight line under the K lines. */
static double lines_share(const skg_spectrum *spectrum) {
    double energy[512], photons[512], all = 0, lines = 0;
    int64_t count = 0;
    ck_skg(skg_spectrum_bin_count(spectrum, &count));
    ck_assert_int_lt(count, 512);
    for (int64_t i = 0; i < count; i++) {
        ck_skg(skg_spectrum_bin_get(spectrum, i, &energy[i], &photons[i]));
        all += photons[i];
    }
    static const double windows[2][2] = {{56.5, 60.5}, {65.5, 70.5}};
    for (int w = 0; w < 2; w++) {
        int64_t a = -1, b = -1;
        for (int64_t i = 0; i < count; i++) {
            if (fabs(energy[i] - windows[w][0]) < 0.01) a = i;
            if (fabs(energy[i] - windows[w][1]) < 0.01) b = i;
        }
        for (int64_t i = a + 1; i < b; i++)
            lines += photons[i] - photons[a] - (photons[b] - photons[a]) * (double)(i - a) / (double)(b - a);
    }
    return lines / all;
}

START_TEST(k_lines_share) {
    static const double rows[][2] = {{80, .016}, {100, .057}, {120, .087}, {150, .112}};
    static const layer layers[] = {{"Al", 2.5}, {NULL, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int32_t model = SKG_TUBE_MODEL_EBEL; model <= SKG_TUBE_MODEL_BIRCH; model++) {
            skg_spectrum *s = tube(model, rows[i][0], 12, layers);
            double share = lines_share(s);
            if (getenv("SKG_LIST"))
                printf("model %d, %g kV: lines %.2f %%\n", model, rows[i][0], 100 * share);
            ck_assert_msg(fabs(share / rows[i][1] - 1) <= 0.15, "%g kV: lines %.2f %%", rows[i][0],
                          100 * share);
            skg_spectrum_release(&s);
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
    ck_assert_double_eq_tol(other.photons / one.photons, 0.25, 1e-12);
    t.mas = 1, t.distance_mm = 1000, t.pixel_mm2 = 1;
    t.output_ugy_mas = 65; /* at 1 m */
    ck_skg(skg_spectrum_create_tube(&t, &s));
    ck_skg(skg_spectrum_quality_get(s, &other));
    skg_spectrum_release(&s);
    ck_assert_double_eq_tol(other.air_kerma_ugy, 65, 1e-10);
    t.output_ugy_mas = 0, t.bin_kev = 0.5; /* bins of another width: the same beam */
    ck_skg(skg_spectrum_create_tube(&t, &s));
    ck_skg(skg_spectrum_quality_get(s, &other));
    skg_spectrum_release(&s);
    ck_assert_double_eq_tol(other.air_kerma_ugy / one.air_kerma_ugy, 1, 5e-3);
    skg_material_release(&al);
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
    tcase_add_test(tests, ebel_agrees_with_ptb);
    tcase_add_test(tests, birch_agrees_with_ptb);
    tcase_add_test(tests, iso_qualities);
    tcase_add_test(tests, homogeneity_of_rqr);
    tcase_add_test(tests, output_per_mas);
    tcase_add_test(tests, k_lines_share);
    tcase_add_test(tests, beam_of_figure_4);
    tcase_add_test(tests, output_scales);
    tcase_add_test(tests, tubes_that_cannot_be);
}

SKG_SUITE_MAIN("tube", add_tests)
