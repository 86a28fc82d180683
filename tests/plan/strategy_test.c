/* The strategy that a scene calls for. */
#include "plan/choose.h"
#include "suite.h"

START_TEST(strategy_follows_from_the_facts) {
    const char *why = NULL;
    skg_strategy_facts facts = {
        .workers = 2, .image_bytes = 1 << 20, .triangles = 41616, .triangle_pixels = 20};
    ck_assert_int_eq(skg_strategy_choose(&facts, &why), SKG_STRATEGY_COPIES);
    facts.workers = 64;
    ck_assert_int_eq(skg_strategy_choose(&facts, &why), SKG_STRATEGY_TILES);
    facts = (skg_strategy_facts){
        .workers = 2, .image_bytes = 16 << 20, .triangles = 168100, .triangle_pixels = 80};
    ck_assert_int_eq(skg_strategy_choose(&facts, &why), SKG_STRATEGY_TILES);
    facts.triangle_pixels = 10;
    ck_assert_int_eq(skg_strategy_choose(&facts, &why), SKG_STRATEGY_COPIES);
    facts.is_gpu = 1;
    ck_assert_int_eq(skg_strategy_choose(&facts, &why), SKG_STRATEGY_ATOMICS);
    ck_assert_ptr_nonnull(why);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, strategy_follows_from_the_facts);
}

SKG_SUITE_MAIN("strategy", add_tests)
