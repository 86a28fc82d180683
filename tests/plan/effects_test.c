/* The table of effects: every row can be reported and tested, and the documentation lists the same effects. */
#include "plan/decisions.h"
#include "plan/rules.h"
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

START_TEST(every_row_is_complete) {
    for (int e = 0; e < SKG_EFFECTS; e++) {
        const skg_effect_row *row = skg_effect_row_get(e);
        ck_assert_msg(row->name && row->name[0] && row->find, "row %d", e);
        ck_assert_int_lt(row->self_test, SKG_SELF_TESTS);
        for (int other = 0; other < e; other++) ck_assert_str_ne(row->name, skg_effect_row_get(other)->name);
    }
}
END_TEST

START_TEST(the_documentation_lists_the_rows) {
    char line[512], expected[64];
    int e = 0, in_table = 0;
    FILE *page = fopen(SKG_SOURCE "/docs/scene-files.md", "r");
    ck_assert_ptr_nonnull(page);
    while (fgets(line, sizeof line, page)) {
        if (strncmp(line, "| effect |", 10) == 0) {
            in_table = 1;
        } else if (in_table && line[0] != '|') {
            break;
        } else if (in_table && line[1] != '-') {
            ck_assert_int_lt(e, SKG_EFFECTS);
            snprintf(expected, sizeof expected, "| %s |", skg_effect_row_get(e)->name);
            line[strlen(expected)] = '\0';
            ck_assert_str_eq(line, expected);
            e++;
        }
    }
    fclose(page);
    ck_assert_int_eq(e, SKG_EFFECTS);
}
END_TEST

/* Finds a word in the files of a folder. */
static int has_word(const char *folder, const char *word) {
    char command[512];
    snprintf(command, sizeof command, "grep -rqwF -- '%s' '%s/%s'", word, SKG_SOURCE, folder);
    return system(command) == 0;
}

/* Rows that derivatives neither go back through nor are refused with. */
static int needs_no_adjoint(const char *name) {
    return !strcmp(name, "repair")           /* of leaky meshes, which are refused */
           || !strcmp(name, "source plane")  /* refused where a pass finds a part there */
           || !strcmp(name, "overlap check") /* changes nothing */
           || !strcmp(name, "noise power");  /* derivatives are those of the expected image */
}

START_TEST(every_row_has_derivatives_or_refuses_them) {
    for (int e = 0; e < SKG_EFFECTS; e++) {
        const skg_effect_row *row = skg_effect_row_get(e);
        if (row->adjoint)
            ck_assert_msg(has_word("lib/gradient", row->adjoint) || has_word("kernels", row->adjoint) ||
                              has_word("kernels/CMakeLists.txt", row->adjoint),
                          "%s: nothing is called %s", row->name, row->adjoint);
        else
            ck_assert_msg(row->refuses_gradient || needs_no_adjoint(row->name), "%s", row->name);
    }
}
END_TEST

/* A recipe that asks for everything that half precision refuses. */
START_TEST(half_names_every_row_that_refuses_it) {
    static const skg_heel heel;
    static const skg_bowtie bowtie;
    static const skg_grid grid;
    static const skg_scatter scatter;
    static skg_material *const world = (skg_material *)1; /* is not looked at */
    static skg_counter *const counter = (skg_counter *)1; /* nor is this */
    skg_recipe recipe = {.leaky_count = 0};
    char names[512];
    skg_plan_options *options = &recipe.options;
    ck_assert_int_eq(skg_effects_refuse_half(&recipe, sizeof names, names), 0);
    recipe.is_blurred = recipe.priority_possible = 1, recipe.leaky_count = recipe.volume_count = 1;
    recipe.view.radius = 1000;
    options->world = world, options->counter = counter;
    options->heel = &heel, options->bowtie = &bowtie, options->grid = &grid, options->scatter = &scatter;
    options->noise = options->oblique = 1;
    options->electronic_kev = options->quantum_step_kev = 1;
    int refused = skg_effects_refuse_half(&recipe, sizeof names, names);
    for (int e = 0; e < SKG_EFFECTS; e++) {
        const skg_effect_row *row = skg_effect_row_get(e);
        if (!row->refuses_half) continue;
        refused--;
        ck_assert_msg(strstr(names, row->name) != NULL, "%s is not in: %s", row->name, names);
    }
    ck_assert_int_eq(refused, 0);
}
END_TEST

/* The prediction of scatter leaves out all but what it is simulated with: then the options are those of a plan that asks for nothing. */
START_TEST(the_prediction_leaves_out_what_it_does_not_simulate) {
    static const double edges[2] = {10, 20};
    static const skg_heel heel;
    static const skg_grid grid;
    static const skg_scatter scatter;
    skg_plan_options options, none;
    skg_plan_options_init(&options);
    none = options;
    options.bands = 1, options.band_kev = edges;
    options.heel = &heel, options.grid = &grid, options.scatter = &scatter;
    options.noise = options.oblique = 1;
    options.supersampling = 3;
    options.electronic_kev = options.quantum_step_kev = 1;
    skg_effects_leave_out(&options);
    ck_assert_ptr_eq(options.grid, &grid);
    ck_assert_ptr_eq(options.scatter, &scatter);
    for (int e = 0; e < SKG_EFFECTS; e++)
        if (skg_effect_row_get(e)->predicted) skg_effect_row_get(e)->leave_out(&options);
    none.overlaps = 0; /* is looked for when the scene's own plan is made */
    none.falloff = SKG_FALLOFF_OFF;
    none.supersampling = 1;
    ck_assert_mem_eq(&options, &none, sizeof none);
}
END_TEST

/* The page says when an effect is on, by its key. */
START_TEST(the_documentation_names_the_keys) {
    char line[512], row_begins[64], key[64];
    FILE *page = fopen(SKG_SOURCE "/docs/scene-files.md", "r");
    ck_assert_ptr_nonnull(page);
    int found = 0, wanted = 0;
    for (int e = 0; e < SKG_EFFECTS; e++) wanted += skg_effect_row_get(e)->key != NULL;
    while (fgets(line, sizeof line, page))
        for (int e = 0; e < SKG_EFFECTS; e++) {
            const skg_effect_row *row = skg_effect_row_get(e);
            snprintf(row_begins, sizeof row_begins, "| %s | ", row->name);
            if (!row->key || strncmp(line, row_begins, strlen(row_begins)) != 0) continue;
            snprintf(key, sizeof key, "`%s`", row->key);
            ck_assert_msg(strstr(line, key) != NULL, "%s is not in: %s", key, line);
            ck_assert_msg(has_word("host/files/setup", row->key), "no reader of scene files knows %s",
                          row->key);
            found++;
        }
    fclose(page);
    ck_assert_int_eq(found, wanted);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, every_row_has_derivatives_or_refuses_them);
    tcase_add_test(tests, half_names_every_row_that_refuses_it);
    tcase_add_test(tests, the_prediction_leaves_out_what_it_does_not_simulate);
    tcase_add_test(tests, the_documentation_names_the_keys);
    tcase_add_test(tests, every_row_is_complete);
    tcase_add_test(tests, the_documentation_lists_the_rows);
}

SKG_SUITE_MAIN("effects", add_tests)
