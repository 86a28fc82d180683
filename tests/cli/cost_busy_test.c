/* The verb cost on a busy machine and in too little time: what it says of errors that it did not measure, and of prices. */
#include "cli/cost_scene.h"

#include <float.h>
#include <math.h>
#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

static const char grey[] = "--set 'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":100}]'";
static const char round_bone[] = "--set Samples.bone.Sphere.0=32";

enum { SPINNERS = 4 };
static pid_t spinners[SPINNERS];

static void begin_to_spin(void) {
    for (int i = 0; i < SPINNERS; i++) {
        spinners[i] = fork();
        ck_assert_int_ge(spinners[i], 0);
        if (spinners[i] > 0) continue;
        alarm(300); /* a failed assertion does not stop them */
        for (volatile unsigned n = 0;; n++) {
        }
    }
}

static void stop_spinning(void) {
    for (int i = 0; i < SPINNERS; i++) {
        kill(spinners[i], SIGKILL);
        ck_assert_int_eq(waitpid(spinners[i], NULL, 0), spinners[i]);
    }
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static json_t *source_of(json_t *study, const char *name) {
    json_t *source;
    size_t i;
    json_array_foreach(member(study, "sources"), i, source) {
        if (strcmp(json_string_value(member(source, "name")), name) == 0) return source;
    }
    ck_abort_msg("no source %s", name);
    return NULL;
}

static const char *text_of(json_t *object, const char *key) {
    const char *text = json_string_value(member(object, key));
    return text ? text : "";
}

static int is_state(json_t *source, const char *state) {
    return strcmp(text_of(source, "state"), state) == 0;
}

/* Scatter, which no setting has and which has a sentence of its own. */
static int is_scatter(json_t *source) {
    return strcmp(text_of(source, "name"), "scatter") == 0;
}

/* The source with the largest error; "": none was measured. */
static const char *largest_of(json_t *study) {
    const char *name = "";
    double largest = 0;
    json_t *source;
    size_t i;
    json_array_foreach(member(study, "sources"), i, source) {
        const double error = json_number_value(member(source, "error"));
        if (is_scatter(source)) continue;
        if (error > largest) largest = error, name = text_of(source, "name");
    }
    return name;
}

/* The sentence, the sources and the settings say the same of errors: what was not measured has that reason and is listed, and only
 * what was measured is named. */
static void check_errors_said(json_t *study) {
    const char *summary = text_of(study, "summary"), *largest = largest_of(study);
    int measured = 0, missing = 0;
    json_t *source;
    size_t i;
    json_array_foreach(member(study, "sources"), i, source) {
        const char *reason = text_of(source, "reason");
        const int is_missing = is_state(source, "not measured");
        measured += !is_scatter(source) && (is_state(source, "coarse") || is_state(source, "measured"));
        missing += is_missing;
        if (is_missing) ck_assert_msg(strncmp(reason, "not measured: ", 14) == 0, "%s", reason);
        if (is_missing || is_state(source, "not known")) ck_assert(json_is_null(member(source, "error")));
        if (is_missing)
            ck_assert_ptr_nonnull(strstr(strstr(summary, " Not measured: "), text_of(source, "name")));
        ck_assert(is_missing || !strstr(reason, "time did not suffice"));
    }
    ck_assert_int_eq(strstr(summary, " Not measured: ") != NULL, missing > 0);
    if (measured == 0) ck_assert_ptr_nonnull(strstr(summary, " No source of error was measured."));
    if (measured == 0 || *largest) ck_assert_ptr_null(strstr(summary, "is above 0"));
    if (!*largest) return;
    char said_so[96];
    snprintf(said_so, sizeof said_so, " Largest error%s: %s (", missing ? " of those measured" : "", largest);
    ck_assert_msg(strstr(summary, said_so) != NULL, "%s in: %s", said_so, summary);
}

/* No advice claims an error below one that a source is known to have, or may have. */
static void check_advice_said(json_t *study) {
    static const char *const dials[] = {"supersampling", "triangles"};
    json_t *advice;
    size_t i;
    json_array_foreach(member(study, "advice"), i, advice) {
        const double bar = json_number_value(member(advice, "bar"));
        for (int k = 0; k < 2; k++) {
            json_t *source = source_of(study, dials[k]);
            const int is_above =
                is_state(source, "coarse") && json_number_value(member(source, "error")) > bar;
            if (is_above || is_state(source, "not measured"))
                ck_assert_ptr_nonnull(strstr(text_of(advice, "reason"), dials[k]));
        }
    }
}

static double price_of(json_t *setting) {
    return json_number_value(member(member(setting, "price"), "ms"));
}

/* Every setting has a price, and so has what halves an error. The sentence has that of the scene's image. */
static void check_prices_said(json_t *study) {
    json_t *source,
        *here = json_array_get(member(study, "settings"), (size_t)json_integer_value(member(study, "here")));
    double said_ms = 0;
    size_t i;
    json_array_foreach(member(study, "sources"), i, source) ck_assert_int_eq(
        json_is_number(member(source, "halving_ms")), json_is_string(member(source, "halving")));
    ck_assert_int_eq(sscanf(text_of(study, "summary"), "This scene: %lf ", &said_ms), 1);
    /* Two significant digits are within 5 %. */
    ck_assert_double_eq_tol(said_ms, price_of(here), 0.05 * price_of(here));
}

/* The measured setting of another study that equals this one; NULL: it was not measured there. */
static json_t *same_setting(json_t *study, json_t *setting) {
    json_t *other;
    size_t i;
    json_array_foreach(member(study, "settings"), i, other) {
        if (json_equal(member(other, "setting"), member(setting, "setting"))) return other;
    }
    return NULL;
}

/* Prices of settings whose image takes 2 ms or more stay, by the median within a factor of 2, while on two cores the same images take
 * two to five times as long on the wall. Measured beside four idle loops: .84 to 1.3 times, median 1.03; beside compilers, which take
 * memory's bandwidth and caches as well, 1.7. Shorter images are within the time that a thread takes to wake up. */
static void check_prices_stay(json_t *quiet, json_t *busy) {
    enum { MOST = 64 };
    double off[MOST];
    int count = 0;
    json_t *setting;
    size_t i;
    json_array_foreach(member(busy, "settings"), i, setting) {
        json_t *before = same_setting(quiet, setting);
        if (!before || price_of(before) < 2 || count == MOST) continue;
        off[count++] = fabs(log(price_of(setting) / price_of(before)));
    }
    if (count == 0) return; /* a machine on which every image is shorter */
    qsort(off, (size_t)count, sizeof *off, ascending);
    ck_assert_double_le(off[count / 2], log(2));
}

/* Errors need no quiet machine: beside four busy processes each source has the same error, and the same one is the largest. Prices are
 * processor time. */
START_TEST(a_busy_machine_changes_no_error_and_no_price) {
    static const char large[] = "--set Detector.NumberOfPixels=[512,400]";
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s %s %s", large, grey, round_bone);
    json_t *quiet = said_json();
    begin_to_spin();
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s %s %s", large, grey, round_bone);
    stop_spinning();
    json_t *busy = said_json(), *source;
    size_t i;
    check_errors_said(quiet);
    check_prices_said(quiet);
    check_errors_said(busy);
    check_prices_said(busy);
    check_prices_stay(quiet, busy);
    ck_assert_str_eq(largest_of(busy), largest_of(quiet));
    json_array_foreach(member(busy, "sources"), i, source) {
        json_t *before = source_of(quiet, text_of(source, "name"));
        ck_assert(json_equal(member(source, "error"), member(before, "error")));
        ck_assert_str_eq(text_of(source, "state"), text_of(before, "state"));
    }
    json_decref(quiet);
    json_decref(busy);
}
END_TEST

/* The generated thorax, whose finer meshes take seconds: with little time the same source is the largest as with much, or it is
 * said that this one was not measured; and never that the bodies are not known, which they are. */
START_TEST(little_time_names_the_same_error_or_none) {
    static const int seconds[] = {1, 10};
    static const char small[] = "--set Detector.NumberOfPixels=[33,25]";
    ck_run(0, "thorax -o t --simple --triangles 10000 --quiet");
    ck_run(0, "cost t/thorax.json --quick --within 3600 --json %s %s", small, grey);
    json_t *much = said_json();
    const char *largest = largest_of(much);
    check_errors_said(much);
    check_prices_said(much);
    ck_assert(is_state(source_of(much, "triangles"), "measured"));
    ck_assert_str_ne(largest, "");
    for (int i = 0; i < 2; i++) {
        begin_to_spin();
        ck_run(0, "cost t/thorax.json --within %d --json %s %s", seconds[i], small, grey);
        stop_spinning();
        json_t *little = said_json();
        check_errors_said(little);
        check_prices_said(little);
        check_advice_said(little);
        ck_assert_ptr_null(strstr(text_of(source_of(little, "triangles"), "reason"), "is not known"));
        if (!is_state(source_of(little, largest), "not measured"))
            ck_assert_str_eq(largest_of(little), largest);
        json_decref(little);
    }
    json_decref(much);
    ck_run(0, "cost t/thorax.json --within 1 %s %s", small, grey);
    ck_assert_ptr_nonnull(
        strstr(said, "\n  triangles                          ?  not measured: the time did not suffice\n"));
    char line[256];
    snprintf(line, sizeof line, "rm -rf %s/t", folder);
    ck_assert_int_eq(system(line), 0);
}
END_TEST

/* A mesh from a file stands for a body that is not known; this is its reason, whatever the time. */
START_TEST(an_unknown_body_is_said_to_be_unknown) {
    write_text("box.obj",
               "v -9 -9 -9\nv 9 -9 -9\nv -9 9 -9\nv -9 -9 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    ck_run(
        0,
        "cost 'small scene.json' --quick --within 3600 --json %s --set 'Samples.bone={\"Label\":\"bone\",\"Path\":\"box.obj\","
        "\"Unit\":\"mm\",\"Material\":[\"HU\",900]}'",
        grey);
    json_t *study = said_json(), *triangles = source_of(study, "triangles"),
           *surface = source_of(study, "true surface");
    check_errors_said(study);
    check_prices_said(study);
    ck_assert(is_state(triangles, "not known") && is_state(surface, "not known"));
    ck_assert_ptr_nonnull(
        strstr(text_of(triangles, "reason"), "the body that the triangles stand for is not known"));
    json_decref(study);
}
END_TEST

/* The table says what the JSON says: the same settings, prices, times and errors. */
START_TEST(the_table_says_what_the_json_says) {
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json -o a.csv %s %s", grey, round_bone);
    json_t *study = said_json(), *point;
    char *table = read_page("a.csv"), *rest = NULL;
    ck_assert_ptr_nonnull(strtok_r(table, "\n", &rest));
    size_t i;
    json_array_foreach(member(study, "points"), i, point) {
        const char *line = strtok_r(NULL, "\n", &rest);
        double values[26];
        int count = 0;
        ck_assert_ptr_nonnull(line);
        for (const char *at = line; at && count < 26; count++) {
            values[count] = strtod(at, NULL);
            at = strchr(at, ',');
            at = at ? at + 1 : NULL;
        }
        ck_assert_int_eq(count, 26);
        const double ms = price_of(point), now = json_number_value(member(point, "wall_now_ms")),
                     rms = json_number_value(member(point, "rms_open"));
        enum { DIGITS = 6 }; /* of the table */
        const double rounding = pow(10, 1 - DIGITS);
        ck_assert_double_le(fabs(values[14] - ms), rounding * ms);
        ck_assert_double_le(fabs(values[17] - now), rounding * now);
        ck_assert_double_le(fabs(values[20] - rms), rounding * rms);
    }
    ck_assert_ptr_null(strtok_r(NULL, "\n", &rest));
    free(table);
    json_decref(study);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, a_busy_machine_changes_no_error_and_no_price);
    tcase_add_test(tests, little_time_names_the_same_error_or_none);
    tcase_add_test(tests, an_unknown_body_is_said_to_be_unknown);
    tcase_add_test(tests, the_table_says_what_the_json_says);
}

SKG_SUITE_MAIN("cost_busy", add_tests)
