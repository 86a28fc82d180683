/* Every named breath of generated thoraxes with small facets. */
#include "breather.h"

#include "suite.h"

START_TEST(named_breaths) {
    breather thorax = {0};
    breather_make(&thorax, 935000, _i, NULL);
    breather_check(&thorax, 10, 1); /* mm, from which on a body warns */
    breather_drop(&thorax);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, named_breaths, 0, 2);
}

SKG_SUITE_MAIN("breaths of large thoraxes", add_tests)
