/* Half-value layers of tube spectra against those that the PTB measured: needs the data. */
#include "beam/tube.h"
#include "data.h"
#include "suite.h"

#include <math.h>
#include <string.h>

typedef struct {
    double first, second, ratio;
    char first_at[32], second_at[32];
} worst;

static void note(double deviation, const char *name, double *most, char *at) {
    if (fabs(deviation) <= fabs(*most)) return;
    *most = deviation;
    snprintf(at, 32, "%s", name);
}

/* IEC qualities, closes the file: RQR and RQA, half-value layers in mm Al. */
static void iec(FILE *file, int32_t model, const char *label, double first_bar, double second_bar,
                double ratio_bar) {
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
    FILE *file;
    open_data(file, "physics/beam_qualities.csv");
    iec(file, SKG_TUBE_MODEL_EBEL, "Ebel", 0.03, 0.03, 0.025);
}
END_TEST

START_TEST(birch_agrees_with_ptb) {
    FILE *file;
    open_data(file, "physics/beam_qualities.csv");
    iec(file, SKG_TUBE_MODEL_BIRCH, "Birch", 0.07, 0.05, 0.025);
}
END_TEST

/* ISO 4037 qualities: half-value layers in mm Cu; nominal mean energies of the N series. */
START_TEST(iso_qualities) {
    FILE *file;
    open_data(file, "physics/beam_qualities_iso_cu.csv");
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
        /* The aim of the calibration for HVL1 in aluminium; mean energies are nominal to 0.5 keV. */
        ck_assert_msg(fabs(q.hvl1_mm_cu / hvl1 - 1) <= 0.03, "%s: HVL1 %.4f mm Cu", name, q.hvl1_mm_cu);
        ck_assert_msg(fabs(q.hvl2_mm_cu / hvl2 - 1) <= 0.03, "%s: HVL2 %.4f mm Cu", name, q.hvl2_mm_cu);
        for (size_t i = 0; i < sizeof nominal / sizeof *nominal; i++)
            if (strcmp(nominal[i].name, name) == 0) /* The model of the tube, as above. */
                ck_assert_msg(fabs(q.mean_kev - nominal[i].mean) <= 0.5, "%s: mean %.2f keV", name,
                              q.mean_kev);
        rows++;
    }
    fclose(file);
    ck_assert_int_eq(rows, 12);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, ebel_agrees_with_ptb);
    tcase_add_test(tests, birch_agrees_with_ptb);
    tcase_add_test(tests, iso_qualities);
}

SKG_SUITE_MAIN("qualities", add_tests)
