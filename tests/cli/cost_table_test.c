/* The verb cost: its table, .csv, JSON and page, prices, and sources of error. */
#include "cli/cost_scene.h"

#include <float.h>
#include <math.h>

/* Runs a line as a shell does, with `skiagraph` in it. */
static void run_line(const char *line) {
    char text[4096];
    snprintf(text, sizeof text, "cd %s && skiagraph() { '%s' \"$@\"; } && %s >.said 2>&1", folder,
             SKG_COMMAND, line);
    ck_assert_msg(system(text) == 0, "%s", line);
}

START_TEST(thorax_and_breath_are_swept) {
    static const char small[] = "--set Detector.NumberOfPixels=[33,25] --set "
                                "'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":100}]'";
    double rms[16], mm[16];
    ck_run(0, "thorax -o t --simple --triangles 10000 --quiet");
    ck_run(0, "cost t/thorax.json --quick --within 3600 --json %s", small);
    json_t *study = said_json();
    int count = list_dial(study, "triangles", "rms_mm", mm);
    ck_assert_int_eq(count, 5); /* the scene's, 10500, 21000, 42000, 84000, against 168000 */
    ck_assert_double_lt(mm[4], mm[0] / 4);
    run_line(json_string_value(member(json_array_get(member(study, "advice"), 3), "whole_command")));
    ck_assert(has_file("thorax-84000/thorax.json"));
    ck_assert(has_file("image.mha"));
    count = list_dial(study, "relaxation", "max_mm", mm);
    ck_assert_int_eq(count, 3);
    ck_assert(mm[0] == 0); /* without relaxation, as the reference: the same bits */
    ck_assert(mm[1] > 0 && mm[2] > mm[1]);
    ck_assert_int_eq(list_dial(study, "hysteresis", "max_mm", mm), 1);
    ck_assert_int_eq(list_dial(study, "hysteresis", "rms_open", rms), 1);
    ck_assert(mm[0] > 0 && rms[0] > 0);
    json_decref(study);
    char line[256];
    snprintf(line, sizeof line, "rm -rf %s/t %s/thorax-84000", folder, folder);
    ck_assert_int_eq(system(line), 0);
}
END_TEST

START_TEST(table_csv_and_page_are_written) {
    ck_run(0, "cost 'small scene.json' --quick --within 3600 -o a.html");
    ck_assert_str_eq(complained, "");
    ck_assert_int_eq(strncmp(said, "This scene: ", 12), 0);
    ck_assert_ptr_nonnull(strstr(said, "Largest error: "));
    ck_assert_ptr_nonnull(strstr(said, "\n  supersampling "));
    ck_assert_ptr_nonnull(strstr(said, "\n  scatter "));
    ck_assert_ptr_nonnull(strstr(said, "\n  1e-06 "));
    ck_assert_ptr_nonnull(strstr(said, "skiagraph image 'small scene.json' -o image.mha --precision "));
    ck_assert_ptr_nonnull(strstr(said, "wrote a.html, and its table as .csv\n"));
    char *page = read_page("a.html"), *table = read_page("a.csv");
    ck_assert_ptr_null(strstr(page, "http"));
    ck_assert_ptr_null(strstr(page, "\"STUDY\""));
    ck_assert_ptr_nonnull(strstr(page, "data:image/png;base64,iVBORw0KGgo")); /* a PNG's first bytes */
    ck_assert_ptr_nonnull(strstr(page, "</html>"));
    ck_assert_int_eq(strncmp(table, "dial,precision,tolerance,", 25), 0);
    int lines = 0, commas = 0;
    for (const char *at = table; *at; at++) lines += *at == '\n', commas += *at == ',';
    ck_assert_int_gt(lines, 12);
    ck_assert_int_eq(commas, 25 * lines);
    ck_assert_int_eq(look_at_folder(0), 3); /* no half-written file */
    free(page);
    free(table);
}
END_TEST

/* A price is always given, with its uncertainty and its clock; here by processor time, which is no longer than the wall's. */
static void check_price(json_t *setting) {
    json_t *price = member(setting, "price");
    ck_assert_double_gt(number(price, "ms"), 0);
    ck_assert_double_ge(number(price, "uncertainty"), 0);
    ck_assert_str_eq(json_string_value(member(price, "clock")), "cpu");
    ck_assert_double_le(number(price, "ms"), number(setting, "wall_now_ms"));
}

/* A setting is computed and timed once, whatever it is compared with, and the scene as it is stands among them. */
static void check_settings(json_t *study) {
    json_t *settings = member(study, "settings"), *here, *setting, *point;
    size_t i, k;
    here = json_array_get(settings, (size_t)json_integer_value(member(study, "here")));
    ck_assert_str_eq(json_string_value(member(here, "dial")), "scene");
    json_array_foreach(settings, i, setting) {
        check_price(setting);
        for (k = 0; k < i; k++)
            ck_assert(
                !json_equal(member(setting, "setting"), member(json_array_get(settings, k), "setting")));
    }
    json_array_foreach(member(study, "points"), i, point) {
        setting = json_array_get(settings, (size_t)json_integer_value(member(point, "settings_index")));
        ck_assert(json_equal(member(setting, "setting"), member(point, "setting")));
        ck_assert(json_equal(member(setting, "price"), member(point, "price")));
        if (json_integer_value(member(point, "reference")) == 6) /* all dials together */
            ck_assert(number(setting, "rms") == number(point, "rms_open"));
    }
}

static json_t *source_of(json_t *study, const char *name) {
    json_t *source;
    size_t i;
    json_array_foreach(member(study, "sources"), i,
                       source) if (strcmp(json_string_value(member(source, "name")), name) ==
                                   0) return source;
    ck_abort_msg("no source %s", name);
    return NULL;
}

/* A sphere of 32 sectors in a cube, one energy, single precision: the triangles err by thousandths of the sphere's contrast at
 * its edge and the single ray a pixel by more, precision by rounding, and the rest not at all. Twice the sectors quarter the
 * error of the triangles. The errors of all sources add as squares to that of the whole, but for what they share: the pixels of
 * the sphere's edge; their sum and their difference bound it. */
START_TEST(sources_of_error_are_told_apart) {
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json --set Samples.bone.Sphere.0=32 --set "
              "'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":100}]'");
    json_t *study = said_json(), *triangles = source_of(study, "triangles"),
           *scatter = source_of(study, "scatter");
    const double faceted = number(triangles, "error"),
                 sampled = number(source_of(study, "supersampling"), "error");
    const double rounded = number(source_of(study, "precision"), "error");
    ck_assert(rounded > 0 && rounded < 1e-6); /* 16 roundings of single */
    ck_assert_double_gt(faceted, 100 * rounded);
    ck_assert_ptr_nonnull(strstr(json_string_value(member(triangles, "halving")), " triangles"));
    ck_assert_ptr_nonnull(
        strstr(json_string_value(member(triangles, "command")), "Samples.bone.Sphere.0=64"));
    ck_assert(json_is_number(member(triangles, "halving_ms")));
    json_t *scattered = member(study, "scatter"), *prices = member(scattered, "prices");
    ck_assert(number(scatter, "error") > 0 && number(scatter, "error") <= number(scatter, "max"));
    ck_assert(number(scattered, "ratio_predicted") > 0 && json_is_true(member(scattered, "called_for")));
    ck_assert_int_eq((int)json_array_size(prices), 3);
    ck_assert(number(json_array_get(prices, 0), "tolerance") == 0.05);
    ck_assert(json_is_true(member(json_array_get(prices, 0), "measured")));
    ck_assert(number(json_array_get(prices, 2), "seconds") > 0);
    static const char *const none[] = {"bins of the spectrum", "tolerance", "source samples", "repair",
                                       "true surface"};
    for (int i = 0; i < 5; i++) ck_assert(number(source_of(study, none[i]), "error") == 0);
    json_t *here =
        json_array_get(member(study, "settings"), (size_t)json_integer_value(member(study, "here")));
    const double whole = number(here, "rms"), sure = number(study, "reference_error");
    ck_assert_double_le(whole, faceted + sampled + sure);
    ck_assert_double_ge(whole, fabs(sampled - faceted) - sure);
    ck_assert(json_is_number(member(study, "unrest")));
    ck_assert_int_eq(strncmp(json_string_value(member(study, "summary")), "This scene: ", 12), 0);
    check_settings(study);
    json_decref(study);
}
END_TEST

/* With hardly any time there is still the scene itself, and what was left out is counted. */
START_TEST(little_time_leaves_settings_out) {
    ck_run(0, "cost 'small scene.json' --within 1 -o a.html --set 'Samples.bone.Material=[\"mu\",0.5]'");
    ck_assert_int_eq(strncmp(said, "This scene: ", 12), 0);
    ck_assert_ptr_nonnull(strstr(said, "with its density\n")); /* why scatter is not predicted, to its end */
    ck_assert_ptr_nonnull(strstr(said, " settings did not fit in 1 s; --within gives more time\n"));
    ck_assert(has_file("a.html") && has_file("a.csv"));
}
END_TEST

/* A signal ends the measurement, not the command: what is done is written. (A shell's background process ignores SIGINT.) */
START_TEST(a_stopped_measurement_is_kept) {
    char line[1024];
    snprintf(line, sizeof line,
             "cd %s && { %s cost 'small scene.json' --verbose --within 3600 -o a.html >said 2>log & pid=$!; "
             "until grep -qs skiagraph: log; do sleep 0.02; done; kill -TERM $pid; wait $pid; }",
             folder, SKG_COMMAND);
    ck_assert_int_eq(system(line), 0);
    read_back("said", said, sizeof said);
    ck_assert_int_eq(strncmp(said, "This scene: ", 12), 0);
    ck_assert_ptr_nonnull(strstr(said, "  stopped: what was measured until then is kept\n"));
    char *page = read_page("a.html");
    ck_assert_ptr_nonnull(strstr(page, "\"stopped\":true"));
    free(page);
}
END_TEST

START_TEST(what_cannot_be_done_is_refused) {
    ck_run_fails(2, "--within", "cost 'small scene.json' --within 0");
    ck_run_fails(2, "--frames", "cost 'small scene.json' --frames 0");

    ck_run_fails(2, "its extension is neither .html nor .csv", "cost 'small scene.json' -o a.png");
    ck_run_fails(5, "nowhere/a.html: cannot be written", "cost 'small scene.json' -o nowhere/a.html");
    ck_run_fails(3, "none.json", "cost none.json --quick");
    ck_run_fails(2, "unknown flag --quik; did you mean --quick", "cost 'small scene.json' --quik");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_set_timeout(tests,
                      1200); /* on a busy machine prices are measured again until they agree, for minutes */
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    if (suite_full()) /* cost_test sweeps other dials, breathe_test moves parts */
        tcase_add_test(tests, thorax_and_breath_are_swept);
    tcase_add_test(tests, table_csv_and_page_are_written);
    tcase_add_test(tests, sources_of_error_are_told_apart);
    tcase_add_test(tests, little_time_leaves_settings_out);
    tcase_add_test(tests, a_stopped_measurement_is_kept);
    tcase_add_test(tests, what_cannot_be_done_is_refused);
}

SKG_SUITE_MAIN("cost_table", add_tests)
