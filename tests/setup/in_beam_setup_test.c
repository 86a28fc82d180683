/* Bow-tie, grid, and what a scintillator does, of scene files. */
#include "setup/setup_files.h"

#include <math.h>

static skg_status load_with(const char *one, const char *two) {
    const char *const settings[] = {one, two};
    skg_setup_release(&setup);
    write_file("scene.json", good);
    return skg_setup_load(NULL, path, two ? 2 : 1, settings, &setup);
}

static skg_plan_options options(void) {
    skg_plan_options o;
    skg_plan_options_init(&o);
    ck_skg(skg_setup_options_get(setup, &o));
    return o;
}

static void check_name(const skg_material *material, const char *name) {
    const char *found = NULL;
    ck_skg(skg_material_name_get(material, &found));
    ck_assert_str_eq(found, name);
}

START_TEST(bowties) {
    ck_skg(load_with("Tolerance=0", NULL));
    ck_assert_ptr_null(options().bowtie);
    ck_skg(load_with("Source.Bowtie={\"Material\": \"Al\", \"Profile\": [[-15, 2], [0, 0.3], [15, 2.5]], "
                     "\"Unit\": \"cm\", \"Direction\": [0, 0, -2]}",
                     NULL));
    const skg_bowtie *bowtie = options().bowtie;
    check_name(bowtie->material, "Al");
    ck_assert_int_eq(bowtie->count, 3);
    ck_assert_double_eq(bowtie->angle_deg[2], 15);
    ck_assert_double_eq(bowtie->path_mm[1], 3);
    ck_assert_double_eq(bowtie->direction[2], -1);
    write_file("motion.csv", "# angle, mm\n-10 9\n10 8\n");
    ck_skg(load_with("Source.Bowtie={\"Material\": \"C\", \"Density\": 1.8, \"Profile\": \"motion.csv\"}",
                     NULL));
    bowtie = options().bowtie;
    double density = 0;
    ck_skg(skg_material_density_get(bowtie->material, &density));
    ck_assert_double_eq(density, 1.8);
    ck_assert_int_eq(bowtie->count, 2);
    ck_assert_double_eq(bowtie->path_mm[1], 8);
    ck_assert_double_eq(bowtie->direction[0], 0); /* along the rows */
}
END_TEST

START_TEST(grids) {
    ck_skg(load_with("Detector.Grid={\"Ratio\": 12, \"LinesPerCm\": 40, \"StripThickness\": [0.05, \"mm\"]}",
                     NULL));
    const skg_grid *grid = options().grid;
    ck_assert_double_eq(grid->focus_mm, 0);
    ck_assert_double_eq(grid->strip_mm, 0.05);
    ck_assert_ptr_null(grid->interspace);
    ck_assert_ptr_null(grid->strip);
    ck_skg(load_with(
        "Detector.Grid={\"Ratio\": 8, \"LinesPerCm\": 52, \"Interspace\": \"Al\", \"FocusDistance\": "
        "[1.2, \"m\"], \"StripThickness\": [40, \"um\"], \"Strip\": \"W\", \"Direction\": [0, 0, 3]}",
        NULL));
    grid = options().grid;
    ck_assert_double_eq(grid->ratio, 8);
    ck_assert_double_eq(grid->lines_per_cm, 52);
    ck_assert_double_eq(grid->focus_mm, 1200);
    ck_assert_double_eq(grid->strip_mm, 0.04);
    ck_assert_double_eq(grid->direction[2], 1);
    check_name(grid->interspace, "Al");
    check_name(grid->strip, "W");
}
END_TEST

#define CSI "\"Material\": \"CsI\", \"Thickness\": 600, \"Unit\": \"um\""

START_TEST(scintillators) {
    double all = 0, left = 0, swank = 0;
    ck_skg(load_with("Detector.Scintillator={" CSI "}", NULL));
    ck_assert_int_eq(options().oblique, 0);
    ck_skg(skg_response_get(options().response, 60, 1, &all, NULL));
    ck_skg(load_with("Detector.Scintillator={" CSI ", \"Escape\": true, \"Oblique\": true}", NULL));
    ck_assert_int_eq(options().oblique, 1);
    ck_skg(skg_response_get(options().response, 60, 1, &left, NULL));
    ck_skg(skg_response_swank_get(options().response, 60, 1, &swank));
    ck_assert(left < 0.95 * all && left > 0.85 * all && swank < 0.99);
    ck_skg(load_with("Detector.Scintillator={" CSI ", \"Escape\": false, \"Oblique\": false}", NULL));
    ck_assert_int_eq(options().oblique, 0);
    ck_skg(skg_response_get(options().response, 60, 1, &left, NULL));
    ck_assert_double_eq(left, all);
    double most = 0;
    ck_skg(load_with("Detector.Scintillator={" CSI ", \"Deposition\": \"all\"}", NULL));
    ck_skg(skg_response_get(options().response, 60, 1, &most, NULL));
    ck_assert_double_eq_tol(
        all / most, 0.99,
        0.005); /* 0.987 with a packing of 0.8 (deposition_test.c), more in a denser layer */
    ck_skg(load_with("Detector.Scintillator={" CSI ", \"Deposition\": \"transport\"}", NULL));
    ck_skg(skg_response_get(options().response, 60, 1, &left, NULL));
    ck_assert_double_eq(left, all);
    double seen = 0;
    ck_skg(load_with("Detector.Scintillator={" CSI
                     ", \"Escape\": true, \"DQE\": [[20, 0.9], [60, 0.7], [100, 0.3]]}",
                     NULL));
    ck_skg(skg_response_get(options().response, 60, 1, &left, &seen));
    ck_skg(skg_response_swank_get(options().response, 60, 1, &swank));
    ck_assert_double_eq_tol(seen * swank, 0.7, 1e-12); /* rounding, some 2e-16 */
    ck_assert_double_lt(left, 0.95 * all);
}
END_TEST

#define DEPTHS "Detector.Scintillator={" CSI ", \"Depths\": "
#define MTF "\"MTF\": [[0, 1], [0.5, 0.7], [50, 0.5]]"

static double sum_of(const skg_detector_blur *blur) {
    double sum = 0;
    for (int64_t n = 0; n < blur->columns; n++) sum += blur->along_row[n];
    return sum;
}

START_TEST(blurs) {
    ck_skg(load_with("Tolerance=0", NULL));
    ck_assert_ptr_null(options().depth_blur);
    ck_assert_ptr_null(options().dqe);
    ck_skg(load_with("Detector.MTF=[[0, 1], [0.5, 0.7], [50, 0.5]]", "Detector.DQE=[[0, 0.7], [50, 0.2]]"));
    ck_assert_int_eq(options().blur->columns % 2, 1);
    ck_assert_ptr_null(options().blur->point);
    ck_assert_double_eq_tol(sum_of(options().blur), 1, 1e-12); /* rounding of some hundred terms */
    ck_assert_int_eq(options().dqe->count, 2);
    ck_assert_double_eq(options().dqe->per_mm[1], 50);
    ck_assert_double_eq(options().dqe->dqe[1], 0.2);
    ck_skg(load_with(DEPTHS "[{\"To\": 0.25, \"LSF\": [0.2, 0.6, 0.2]}, {\"To\": 1, " MTF "}]}", NULL));
    const skg_depth_blur *depths = options().depth_blur;
    ck_assert_int_eq(depths->count, 2);
    ck_assert_double_eq(depths->to[0], 0.25);
    ck_assert_int_eq(depths->blur[0].rows, 3);
    ck_assert_double_eq_tol(sum_of(&depths->blur[1]), 1, 1e-12); /* the same */
    ck_assert_ptr_null(options().blur);
}
END_TEST

#define STRIP "\"StripThickness\": [0.05, \"mm\"]"

static const struct {
    const char *setting;
    skg_status status;
    const char *text;
    const char *place;
} bad[] = {
    {"Source.Bowtie={\"Profile\": [[0, 1], [1, 1]]}", SKG_ERR_FORMAT, "Material", "Bowtie"},
    {"Source.Bowtie={\"Material\": \"Al\"}", SKG_ERR_FORMAT, "[[-20, 30], [0, 3], [20, 30]]", "Bowtie"},
    {"Source.Bowtie={\"Material\": \"Al\", \"Profile\": [[0, 1]]}", SKG_ERR_SCENE, "1 rows", "Profile"},
    {"Source.Bowtie={\"Material\": \"Al\", \"Profile\": [[5, 1], [0, 1]]}", SKG_ERR_SCENE, "angles rise",
     "Profile"},
    {"Source.Bowtie={\"Material\": \"Al\", \"Profile\": [[0, 1], [5, -1]]}", SKG_ERR_SCENE, "-1 mm",
     "Profile"},
    {"Source.Bowtie={\"Material\": \"Al\", \"Profile\": [[0, 1], [5]]}", SKG_ERR_FORMAT, "[angle, path]",
     "Profile"},
    {"Source.Bowtie={\"Material\": \"Al\", \"Profle\": 1}", SKG_ERR_FORMAT, "Profile", "Bowtie"},
    {"Detector.Grid={\"LinesPerCm\": 40}", SKG_ERR_FORMAT, "Ratio", "Grid"},
    {"Detector.Grid={\"Ratio\": 12}", SKG_ERR_FORMAT, "LinesPerCm", "Grid"},
    {"Detector.Grid={\"Ratio\": 12, \"LinesPerCm\": 40, " STRIP ", \"FocusDistance\": 1000}", SKG_ERR_FORMAT,
     "\"mm\"", "FocusDistance"},
    {"Detector.Grid={\"Ratio\": 12, \"LinesPerCm\": 40}", SKG_ERR_FORMAT, "StripThickness", "Grid"},
    {"Detector.Grid={\"Ratio\": 12, \"LinesPerCm\": 40, " STRIP ", \"FocusDistance\": [0, \"mm\"]}",
     SKG_ERR_SCENE, "leave FocusDistance out", "FocusDistance"},
    {"Detector.Grid={\"Ratio\": 12, \"LinesPerCm\": 40, \"StripThickness\": [0.3, \"mm\"]}", SKG_ERR_SCENE,
     "one follows another every 0.25 mm", "Grid"},
    {"Detector.Grid={\"Ratio\": 12, \"LinesPerCm\": 40, " STRIP ", \"Interspace\": \"Unobtainium\"}",
     SKG_ERR_MATERIAL, "Unobtainium", "Interspace"},
    {"Detector.Scintillator={" CSI ", \"Escape\": \"yes\"}", SKG_ERR_FORMAT, "true or false", "Escape"},
    {"Detector.Scintillator={" CSI ", \"DQE\": [[60, 0.5]]}", SKG_ERR_BEAM, "two energies", "DQE"},
    {"Detector.Scintillator={" CSI ", \"DQE\": [[60, 0.5], [50, 0.5]]}", SKG_ERR_BEAM, "rise", "DQE"},
    {"Detector.Scintillator={" CSI ", \"DQE\": [[60, 0.5], [70, 1.5]]}", SKG_ERR_BEAM, "1.5", "DQE"},
    {"Detector.Scintillator={" CSI ", \"DQE\": [[60, 0.5], [70]]}", SKG_ERR_FORMAT, "[energy, DQE]", "DQE"},
    {"Detector.Scintillator={" CSI ", \"Deposition\": \"some\"}", SKG_ERR_FORMAT, "transport", "Deposition"},
    {"Detector.Scintillator={" CSI ", \"Oblique\": 2}", SKG_ERR_FORMAT, "give 0 to 1", "Oblique"},
    {"Detector.MTF=[[0, 1], [0.001, 0.5]]", SKG_ERR_FORMAT, "add rows up to there", "MTF"},
    {"Detector.MTF=[[0, 1], [1]]", SKG_ERR_FORMAT, "line pairs per mm", "MTF"},
    {"Detector.DQE=[[0, 1], [1]]", SKG_ERR_FORMAT, "line pairs per mm", "DQE"},
    {DEPTHS "{}}", SKG_ERR_FORMAT, "\"To\": 0.5", "Depths"},
    {DEPTHS "[]}", SKG_ERR_FORMAT, "has 0 depths; give 1 to 8", "Depths"},
    {DEPTHS "[{\"LSF\": [1]}]}", SKG_ERR_FORMAT, "To", "Depths[0]"},
    {DEPTHS "[{\"To\": 1}]}", SKG_ERR_FORMAT, "give LSF, PSF or MTF", "Depths[0]"},
    {DEPTHS "[{\"To\": 1, \"LSF\": [1], " MTF "}]}", SKG_ERR_FORMAT, "one of LSF, PSF and MTF", "Depths[0]"},
    {"Detector.Scintillator={\"Material\": [\"mu\", 3], \"Thickness\": 1, \"Unit\": \"mm\", \"Escape\": true}",
     SKG_ERR_MATERIAL, "has no density", "Scintillator"},
};

START_TEST(refused) {
    ck_skg_fails(load_with(bad[_i].setting, NULL), bad[_i].status, bad[_i].text);
    ck_assert_msg(strstr(skg_last_error(), bad[_i].place) != NULL, "%s: no %s", skg_last_error(),
                  bad[_i].place);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, bowties);
    tcase_add_test(tests, grids);
    tcase_add_test(tests, scintillators);
    tcase_add_test(tests, blurs);
    tcase_add_loop_test(tests, refused, 0, sizeof bad / sizeof *bad);
}

SKG_SUITE_MAIN("in_beam_setup", add_tests)
