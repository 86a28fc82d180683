/* Accumulators that planes are mixed from. */
#include "suite.h"

#include "spectral/model.h"

#include <string.h>

/* Fat in nothing; two bones and a hole of fat in bone, the last also turned round; lung in fat; no matter. */
enum { PARTS = 7, PLANES = 3 };
static const skg_contribution writes[] = {{0, 2, 0},  {1, 1, 0},    {0, -2, 0}, {1, 1, 0},
                                          {0, -2, 0}, {0, 4, 0},    {1, -2, 0}, {2, 0.5, 0},
                                          {0, -2, 0}, {2, 0.25, 0}, {0, -1, 0}};
static const int64_t firsts[PARTS + 1] = {0, 1, 3, 5, 7, 9, 11, 11};

/* Mixed contributions add up to those of their lists. */
static void ck_same(const skg_mix *mix) {
    for (int64_t p = 0; p < PARTS; p++) {
        double given[PLANES] = {0}, mixed[PLANES] = {0};
        for (int64_t w = firsts[p]; w < firsts[p + 1]; w++) given[writes[w].plane] += writes[w].weight;
        ck_assert_int_le(mix->first_contribution[p + 1] - mix->first_contribution[p], 1);
        for (int64_t w = mix->first_contribution[p]; w < mix->first_contribution[p + 1]; w++)
            for (int k = 0; k < PLANES; k++)
                mixed[k] +=
                    mix->contributions[w].weight * mix->lists[mix->contributions[w].plane * PLANES + k];
        ck_assert(memcmp(given, mixed, sizeof given) == 0); /* halves and doubles: exact */
    }
}

START_TEST(parts_that_add_alike_share) {
    skg_mix mix;
    ck_skg(skg_mix_find(PARTS, PLANES, writes, firsts, 4, &mix));
    ck_assert_int_eq(mix.sums, 3); /* fat; fat and bone; fat and lung */
    ck_same(&mix);
    for (int p = 2; p < 4; p++) ck_assert_int_eq(mix.contributions[p].plane, mix.contributions[1].plane);
    ck_assert_double_eq(mix.contributions[3].weight, -2 * mix.contributions[1].weight);
    ck_assert_int_eq(mix.first_contribution[PARTS - 1],
                     mix.first_contribution[PARTS]); /* what adds nothing */
    for (int k = 0; k < PLANES; k++)
        ck_assert_double_eq(mix.lists[3 * PLANES + k], 0); /* space for one more */
    skg_mix_release(&mix);
}
END_TEST

START_TEST(too_many_kinds_are_not_mixed) {
    skg_mix mix;
    ck_skg(skg_mix_find(PARTS, PLANES, writes, firsts, 2, &mix));
    ck_assert_int_eq(mix.sums, 0);
    ck_assert_ptr_null(mix.contributions);
}
END_TEST

START_TEST(only_lists_are_mixed) {
    int32_t sums = -1;
    static const int64_t single[3] = {0, 1, 2};
    ck_skg(skg_mix_choose(PARTS, PLANES, writes, firsts, 3, &sums));
    ck_assert_int_eq(sums, 3);
    ck_skg(skg_mix_choose(PARTS, PLANES, writes, firsts, 2, &sums));
    ck_assert_int_eq(sums, 0);
    ck_skg(skg_mix_choose(2, PLANES, writes, single, 3, &sums));
    ck_assert_int_eq(sums, 0);
    ck_skg(skg_mix_choose(PARTS, 1, (const skg_contribution[]){{0, 1, 0}},
                          (const int64_t[PARTS + 1]){0, 1, 1, 1, 1, 1, 1, 1}, 3, &sums));
    ck_assert_int_eq(sums, 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, parts_that_add_alike_share);
    tcase_add_test(tests, too_many_kinds_are_not_mixed);
    tcase_add_test(tests, only_lists_are_mixed);
}

SKG_SUITE_MAIN("mix", add_tests)
