/* Detectors that count, of scene files. */
#include "setup/setup_files.h"

static skg_status load_with(const char *one, const char *two) {
    const char *const settings[] = {one, two};
    skg_setup_release(&setup);
    write_file("scene.json", good);
    return skg_setup_load(NULL, path, two ? 2 : 1, settings, &setup);
}

#define SENSOR "Detector.Counting={\"Material\": \"CdTe\", \"Thickness\": [1, \"mm\"]"
#define COUNTING SENSOR ", \"Thresholds\": [20, 50]"

START_TEST(counting) {
    skg_plan_options options;
    int64_t count = 0;
    skg_plan_options_init(&options);
    ck_skg(load_with("Tolerance=0", NULL));
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_ptr_null(options.counter);
    ck_skg(load_with(
        COUNTING ", \"ElectronicNoise\": 2, \"Bias\": 400, \"Cloud\": [5, \"um\"], \"Fluorescence\": true, "
                 "\"PileUp\": \"paralysable\", \"DeadTime\": 100, \"ExposureTime\": 0.1}",
        NULL));
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_ptr_nonnull(options.counter);
    ck_assert_int_eq(options.quantity, SKG_QUANTITY_PHOTONS);
    ck_skg(skg_counter_thresholds_get(options.counter, &count));
    ck_assert_int_eq(count, 2);
}
END_TEST

static const struct {
    const char *setting, *other;
    skg_status status;
    const char *text, *place;
} bad[] = {
    {SENSOR "}", NULL, SKG_ERR_FORMAT, "\"Thresholds\": [20, 50]", "Counting"},
    {SENSOR ", \"Thresholds\": []}", NULL, SKG_ERR_FORMAT, "has 0 thresholds; give 1 to 8", "Thresholds"},
    {SENSOR ", \"Thresholds\": [50, 20]}", NULL, SKG_ERR_BEAM, "threshold 2 is 20 keV", "Counting"},
    {COUNTING ", \"ElectronicNoise\": 6}", NULL, SKG_ERR_BEAM, "give at least 24 keV", "Counting"},
    {COUNTING ", \"Bias\": -5}", NULL, SKG_ERR_BEAM, "a bias of -5 V", "Counting"},
    {COUNTING ", \"Cloud\": 5}", NULL, SKG_ERR_FORMAT, "[5, \"um\"]", "Cloud"},
    {COUNTING ", \"Cloud\": [1, \"m\"]}", NULL, SKG_ERR_BEAM, "more than half a pixel", "Counting"},
    {COUNTING ", \"Fluorescence\": \"yes\"}", NULL, SKG_ERR_FORMAT, "true or false", "Fluorescence"},
    {COUNTING ", \"AntiCoincidence\": 2}", NULL, SKG_ERR_FORMAT, "give 0 to 1", "AntiCoincidence"},
    {COUNTING ", \"PileUp\": \"some\"}", NULL, SKG_ERR_FORMAT, "nonparalysable", "PileUp"},
    {COUNTING ", \"DeadTime\": 100}", NULL, SKG_ERR_FORMAT, "matters for pile-up alone", "DeadTime"},
    {COUNTING ", \"PileUp\": \"paralysable\", \"DeadTime\": 100}", NULL, SKG_ERR_FORMAT,
     "ExposureTime is missing", "Counting"},
    {COUNTING ", \"PileUp\": \"paralysable\", \"DeadTime\": 0, \"ExposureTime\": 1}", NULL, SKG_ERR_BEAM,
     "a dead time of 0 ns", "Counting"},
    {COUNTING ", \"Density\": -1}", NULL, SKG_ERR_MATERIAL, "above 0", "Density"},
    {"Detector.Counting={\"Material\": [\"mu\", 3], \"Thickness\": [1, \"mm\"], \"Thresholds\": [20]}", NULL,
     SKG_ERR_MATERIAL, "", "Counting"},
    {COUNTING "}", "Detector.Binning=[2, 2]", SKG_ERR_FORMAT, "not combined with Counting", "Binning"},
    {COUNTING "}", "Detector.MTF=[[0, 1], [10, 0.5]]", SKG_ERR_FORMAT, "not combined with Counting", "MTF"},
};

START_TEST(refused) {
    ck_skg_fails(load_with(bad[_i].setting, bad[_i].other), bad[_i].status, bad[_i].text);
    ck_assert_msg(strstr(skg_last_error(), bad[_i].place) != NULL, "%s: no %s", skg_last_error(),
                  bad[_i].place);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, counting);
    tcase_add_loop_test(tests, refused, 0, sizeof bad / sizeof *bad);
}

SKG_SUITE_MAIN("counting_setup", add_tests)
