/* The strategy that a scene calls for. */
#include "plan/decisions.h"
#include "suite.h"

#include <string.h>

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
    facts.gpu = 1;
    ck_assert_int_eq(skg_strategy_choose(&facts, &why), SKG_STRATEGY_ATOMICS);
    ck_assert_ptr_nonnull(why);
}
END_TEST

/* Whether one pass makes all rays of a pixel: the cases that were measured (choose.c), and the limits. */
START_TEST(rays_of_a_pixel_share_a_pass_where_it_pays) {
    const char *why = NULL;
    skg_fine_request request = {
        .shifts = 1, .columns = 512, .rows = 512, .accumulators = 3, .triangles = 41896};
    ck_assert_int_eq(skg_fine_choose(&request, &why), 1);
    for (int64_t n = 2; n <= 8; n++) {
        request.shifts = n;
        ck_assert_int_eq(skg_fine_choose(&request, &why), n);
    }
    request.shifts = 16; /* 768 MiB */
    ck_assert_int_eq(skg_fine_choose(&request, &why), 1);
    ck_assert_ptr_nonnull(strstr(why, "256 MiB"));
    request.shifts = 2, request.columns = request.rows = 1024;
    ck_assert_int_eq(skg_fine_choose(&request, &why), 1);
    ck_assert_ptr_nonnull(strstr(why, "large"));
    request.triangles = 1000000;
    ck_assert_int_eq(skg_fine_choose(&request, &why), 2);
    request.leaky = 1;
    ck_assert_int_eq(skg_fine_choose(&request, &why), 1);
    ck_assert_ptr_nonnull(strstr(why, "leaky"));
}
END_TEST

/* Planes are mixed from at most 32 accumulators and 128 MiB, but from half as many again as planes in any case. */
START_TEST(planes_are_mixed_from_what_fits) {
    skg_fine_request request = {.shifts = 1, .columns = 512, .rows = 512};
    ck_assert_int_eq(skg_max_mixed(&request, 5), 32);
    request.shifts = 3; /* 9 MiB each */
    ck_assert_int_eq(skg_max_mixed(&request, 5), 14);
    request.precision = SKG_PRECISION_DOUBLE;
    ck_assert_int_eq(skg_max_mixed(&request, 5), 7);
    ck_assert_int_eq(skg_max_mixed(&request, 16), 24);
}
END_TEST

/* How many passes are drawn together: the cases that were measured (choose.c), and the limits. */
START_TEST(passes_are_drawn_together_where_it_pays) {
    int32_t side = 0;
    skg_passes_request request = {.strategy = SKG_STRATEGY_COPIES,
                                  .workers = 2,
                                  .passes = 16,
                                  .image_bytes = 1 << 20,
                                  .triangles = 42000};
    ck_assert_int_eq(skg_passes_choose(&request, &side), 8);
    ck_assert_int_eq(side, 4);
    request.passes = 4; /* too few for four at a time */
    ck_assert_int_eq(skg_passes_choose(&request, &side), 2);
    ck_assert_int_eq(side, 1);
    request.passes = 5; /* a worker would wait in the last turn */
    ck_assert_int_eq(skg_passes_choose(&request, &side), 1);
    request.passes = 1;
    ck_assert_int_eq(skg_passes_choose(&request, &side), 1);
    request.passes = 16, request.image_bytes = 4 << 20;
    ck_assert_int_eq(skg_passes_choose(&request, &side), 2);
    request.triangles = 1002528;
    ck_assert_int_eq(skg_passes_choose(&request, &side), 8);
    request.triangles = 4000000; /* each worker would need memory for four times their vertices */
    ck_assert_int_eq(skg_passes_choose(&request, &side), 2);
    request.workers = 64;
    ck_assert_int_eq(skg_passes_choose(&request, &side), 1);
    request.passes = 64;
    ck_assert_int_eq(skg_passes_choose(&request, &side), 64);
    request.image_bytes = 32 << 20; /* some planes, which leave the caches */
    ck_assert_int_eq(skg_passes_choose(&request, &side), 1);
    request.workers = 2, request.strategy = SKG_STRATEGY_TILES;
    ck_assert_int_eq(skg_passes_choose(&request, &side), 1);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, planes_are_mixed_from_what_fits);
    tcase_add_test(tests, passes_are_drawn_together_where_it_pays);
    tcase_add_test(tests, rays_of_a_pixel_share_a_pass_where_it_pays);
    tcase_add_test(tests, strategy_follows_from_the_facts);
}

SKG_SUITE_MAIN("strategy", add_tests)
