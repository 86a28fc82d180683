/* The table of effects: every row can be reported and tested, and the documentation lists the same effects. */
#include "plan/decisions.h"
#include "suite.h"

#include <stdio.h>
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

static void add_tests(TCase *tests) {
    tcase_add_test(tests, every_row_is_complete);
    tcase_add_test(tests, the_documentation_lists_the_rows);
}

SKG_SUITE_MAIN("effects", add_tests)
