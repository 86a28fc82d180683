/* The verb fit: what it prints and writes, checkpoints, and what it refuses. */
#include "cli/command.h"

#include <math.h>
#include <sys/wait.h>

/* The smallest thorax, in the folder itself. */
static void set_up_thorax(void) {
    set_up();
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
}

/* Differential evolution, because it is in every build. */
#define FIT "fit thorax.json --method de --target liver=diaphragm.ply --phase 0 --parameters tendon "

/* The fitted values of tendon-x, -y, -z. */
static void read_values(double values[3]) {
    json_t *object = said_json(), *list = member(object, "parameters");
    ck_assert_uint_eq(json_array_size(list), 3);
    for (size_t p = 0; p < 3; p++)
        values[p] = json_number_value(json_object_get(json_array_get(list, p), "value"));
    json_decref(object);
}

START_TEST(outputs_are_written_and_read) {
    ck_run(0, FIT "--evaluations 24 -o fitted.json -o page.html -o table.csv -o bars.png --json");
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "evaluations")), 24);
    json_t *part = json_array_get(member(object, "parts"), 0);
    ck_assert_str_eq(json_string_value(member(part, "label")), "liver");
    const double before = json_number_value(member(member(part, "before"), "mean_mm"));
    const double after = json_number_value(member(member(part, "after"), "mean_mm"));
    ck_assert(before > 0 && after > 0 && json_number_value(member(part, "motion_mm")) > 0);
    ck_assert_uint_eq(json_array_size(member(object, "covariance")), 3);
    json_t *z = json_array_get(member(object, "parameters"), 2);
    ck_assert_str_eq(json_string_value(member(z, "name")), "tendon-z");
    ck_assert_str_eq(json_string_value(member(z, "unit")), "mm");
    ck_assert(json_number_value(member(z, "sigma")) > 0);
    json_decref(object);

    char text[65536];
    char path[512];
    snprintf(path, sizeof path, "%s/page.html", folder);
    FILE *page = fopen(path, "r");
    ck_assert_ptr_nonnull(page);
    text[fread(text, 1, sizeof text - 1, page)] = '\0';
    fclose(page);
    ck_assert_ptr_nonnull(strstr(text, "tendon-z"));
    ck_assert_ptr_null(strstr(text, "http"));
    read_back("table.csv", text, sizeof text);
    ck_assert_int_eq(strncmp(text, "label,phase,motion_mm,before_mean_mm", 36), 0);
    ck_assert_ptr_nonnull(strstr(text, "\"liver\",0,"));
    ck_assert_int_eq(has_file("bars.png"), 1);
    ck_run(0, "breathe fitted.json --phase 0 -o posed.png --quiet --json");
    ck_run(
        0,
        "fit fitted.json --method de --target liver=diaphragm.ply --phase 0 --evaluations 12 -o again.json");
    ck_assert_ptr_nonnull(strstr(said, "wrote again.json"));
}
END_TEST

START_TEST(a_checkpoint_continues) {
    double whole[3], halves[3];
    ck_run(0, FIT "--evaluations 48 -o fitted.json --json");
    read_values(whole);
    ck_run(0, FIT "--evaluations 24 -o fitted.json --checkpoint state --json");
    ck_run(0, FIT "--evaluations 48 -o fitted.json --checkpoint state --json");
    ck_assert_ptr_nonnull(strstr(complained, "continues from state"));
    read_values(halves);
    ck_assert_mem_eq(whole, halves, sizeof whole);
    ck_run_fails(3, "is the checkpoint of another fit",
                 FIT "--seed 2 --evaluations 48 -o fitted.json --checkpoint state");
}
END_TEST

/* Killed without warning, again and again, the search comes to the same end. */
START_TEST(killed_searches_continue) {
    double whole[3], pieces[3];
    char line[1024];
    ck_run(0, FIT "--evaluations 240 -o fitted.json --json");
    read_values(whole);
    for (int kill = 0; kill < 3; kill++) {
        snprintf(line, sizeof line,
                 "cd %s && timeout -s KILL 0.4 %s " FIT
                 "--evaluations 240 -o fitted.json --checkpoint state >/dev/null 2>&1",
                 folder, SKG_COMMAND);
        (void)!system(line);
    }
    ck_run(0, FIT "--evaluations 240 -o fitted.json --checkpoint state --json --quiet");
    read_values(pieces);
    ck_assert_mem_eq(whole, pieces, sizeof whole);
}
END_TEST

/* A target of another unit is searched for to the end, and the part is nowhere near it. */
START_TEST(targets_of_another_unit_are_warned_of) {
    char path[512];
    snprintf(path, sizeof path, "%s/far.obj", folder);
    FILE *far = fopen(path, "w");
    ck_assert_ptr_nonnull(far);
    fputs("v 5000 0 0\nv 5150 0 0\nv 5000 150 0\nv 5000 0 150\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", far);
    fclose(far);
    ck_run(
        0,
        "fit thorax.json --method de --target liver=far.obj --phase 0 --parameters tendon --evaluations 12 -o "
        "fitted.json");
    ck_assert_ptr_nonnull(strstr(complained, "--target liver=far.obj: it lies"));
    ck_assert_ptr_null(strstr(complained, "is --unit right?"));
    ck_run(0, FIT "--evaluations 12 -o fitted.json --unit m");
    ck_assert_ptr_nonnull(strstr(complained, "is --unit right?"));
    ck_run(0, FIT "--evaluations 12 -o fitted.json --unit um");
    ck_assert_ptr_nonnull(strstr(complained, "is --unit right?"));
    ck_run(0, FIT "--evaluations 12 -o fitted.json");
    ck_assert_ptr_null(strstr(complained, "--target"));
}
END_TEST

START_TEST(mistakes_are_named) {
    ck_run_fails(2, "the parameter dome-left is not fitted; name it in --parameters",
                 FIT "--bounds dome-left=1:2 -o fitted.json");
    ck_run_fails(2, "at least one target and its phase", "fit thorax.json -o fitted.json");
    ck_run_fails(2, "add -o fitted.json", "fit thorax.json --target liver=liver.ply --phase 0");
    ck_run_fails(2, "none of .json, .html, .csv and .png",
                 "fit thorax.json --target liver=liver.ply --phase 0 -o fitted.txt");
    ck_run_fails(2, "did you mean liver", "fit thorax.json --target lver=liver.ply --phase 0 -o fitted.json");
    ck_run_fails(2, "give PART=FILE", "fit thorax.json --target liver --phase 0 -o fitted.json");
    ck_run_fails(2, "a number from 0 to below 1",
                 "fit thorax.json --target liver=liver.ply --phase 1 -o f.json");
    ck_run_fails(2, "did you mean tendon",
                 "fit thorax.json --target liver=liver.ply --phase 0 --parameters tenon -o f.json");
    ck_run_fails(2, "give NAME=LOW:HIGH",
                 "fit thorax.json --target liver=liver.ply --phase 0 --bounds tendon-z=3 -o f.json");
    ck_run_fails(2, "with the coupling \"Anatomical\"",
                 "fit thorax.json --target liver=liver.ply --phase 0 --parameters plane-offset -o f.json");
    ck_run_fails(3, "nothere.stl", "fit thorax.json --target liver=nothere.stl --phase 0 -o fitted.json");
    ck_assert_int_eq(has_file("fitted.json"), 0);
}
END_TEST

/* Names that a scene has wrong are refused; what --lenient passes over is said; flags change what the scene says. */
START_TEST(the_scene_chooses) {
#define TARGET "--method de --evaluations 12 --target liver=diaphragm.ply --phase 0 -o f.json "
    ck_run(
        0,
        "fit thorax.json " TARGET
        "--set 'Breathing.Fit={\"Parameters\": [\"tendon\"], \"Bounds\": {\"tendon-z\": [-30, -5, \"mm\"]}}' "
        "--json");
    json_t *object = said_json(), *list = member(object, "parameters");
    ck_assert_uint_eq(json_array_size(list), 3);
    ck_assert_double_eq(json_number_value(json_object_get(json_array_get(list, 2), "low")), -30);
    json_decref(object);
    ck_run(
        0,
        "fit thorax.json " TARGET
        "--set 'Breathing.Fit={\"Parameters\": [\"tendon\"]}' --parameters links --set Breathing.Coupling=Paper "
        "--bounds diaphragm-ribs=5:20 --lenient --set Breathing.Moon=1 --json");
    object = said_json(), list = member(object, "parameters");
    ck_assert_uint_eq(json_array_size(list), 2);
    ck_assert_double_eq(json_number_value(json_object_get(json_array_get(list, 0), "high")), 20);
    json_decref(object);
    ck_assert_ptr_nonnull(strstr(complained, "Moon"));
    ck_run_fails(3, "Known are tendon-x",
                 "fit thorax.json " TARGET
                 "--set 'Breathing.Fit={\"Bounds\": {\"tendon-w\": [0, 1, \"mm\"]}}'");
    ck_run_fails(2, "has no part \"zzzzzzzzzz\"",
                 "fit thorax.json --target zzzzzzzzzz=liver.ply --phase 0 -o fitted.json");
}
END_TEST

/* A report for each part and phase. */
START_TEST(several_phases) {
    ck_run(0,
           FIT "--phase 0.25 --target liver=diaphragm.ply --target diaphragm=diaphragm.ply --evaluations 24 "
               "-o fitted.json --json");
    json_t *object = said_json(), *parts = member(object, "parts");
    static const struct {
        const char *label;
        double phase;
    } expected[] = {{"liver", 0}, {"liver", 0.25}, {"diaphragm", 0.25}};
    ck_assert_uint_eq(json_array_size(parts), 3);
    for (size_t t = 0; t < 3; t++) {
        json_t *part = json_array_get(parts, t);
        ck_assert_str_eq(json_string_value(member(part, "label")), expected[t].label);
        ck_assert_double_eq(json_number_value(member(part, "phase")), expected[t].phase);
    }
    json_decref(object);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_thorax, tear_down);
    tcase_add_test(tests, outputs_are_written_and_read);
    tcase_add_test(tests, a_checkpoint_continues);
    if (suite_full())
        tcase_add_test(tests, killed_searches_continue); /* a_checkpoint_continues; scan_test kills */
    tcase_add_test(tests, the_scene_chooses);
    tcase_add_test(tests, several_phases);
    tcase_add_test(tests, targets_of_another_unit_are_warned_of);
    tcase_add_test(tests, mistakes_are_named);
}

SKG_SUITE_MAIN("fit_verb", add_tests)
