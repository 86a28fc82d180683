/* Scales of integers against their bounds. */
#include "geometry/bounds.h"
#include "suite.h"

#include <math.h>

/* The bound leaves 1e-12 of the sum of all parts for rounding, which here is at most four times the largest. */
static const double MARGIN = 1e-11;

/* 512 x 512 pixels; the parts' rectangles are given in pixels. */
static skg_scale find(int64_t count, const skg_scale_part *parts, int32_t bits) {
    skg_scale_grid grid = {0};
    skg_scale scale;
    ck_skg(skg_scale_grid_create(512, 512, &grid));
    skg_scale_find(&grid, count, parts, bits, &scale);
    skg_scale_find(&grid, count, parts, bits, &scale); /* the workspace holds nothing from before */
    skg_scale_grid_release(&grid);
    return scale;
}

START_TEST(one_part_uses_the_range) {
    skg_scale_part part = {100, 200, 100, 200, 1.0, 2.5, 2.0, 1};
    skg_scale scale = find(1, &part, 32);
    ck_assert_int_eq(scale.bits, 32);
    ck_assert(3.0 * scale.scale < 0x1p30 && 3.0 * scale.scale * 2 >= 0x1p30);
    part.multiplicity = 9; /* nine layers of itself must not wrap */
    scale = find(1, &part, 32);
    ck_assert(27.0 * scale.scale < 0x1p30 && 27.0 * scale.scale * 2 >= 0x1p30);
}
END_TEST

START_TEST(a_laminate_shares_the_range) {
    skg_scale_part parts[100];
    for (int i = 0; i < 100; i++) parts[i] = (skg_scale_part){100, 200, 100, 200, i, i + 1.0, 1.0, 1};
    skg_scale scale = find(100, parts, 32);
    ck_assert_double_ge(scale.bound, 100);
    ck_assert_double_le(scale.bound, 100 * (1 + MARGIN));
    ck_assert(100 * scale.scale < 0x1p30);
    ck_assert_int_eq(scale.bits, 32); /* the sum of 100 is what a pixel will really hold */
}
END_TEST

START_TEST(a_swarm_needs_64_bits) {
    /* 10,000 small parts that may overlap by their rectangles, though all lie within a depth of 2. */
    static skg_scale_part parts[10000];
    for (int i = 0; i < 10000; i++)
        parts[i] = (skg_scale_part){100, 110, 100, 110, i % 2, i % 2 + 1.0, 1.0, 1};
    skg_scale scale = find(10000, parts, 32);
    ck_assert_int_eq(scale.bits, 64);
    ck_assert(10000 * scale.scale < 0x1p50 && 10000 * scale.scale * 2 >= 0x1p50);
}
END_TEST

START_TEST(parts_side_by_side_do_not_add) {
    skg_scale_part parts[4];
    for (int i = 0; i < 4; i++)
        parts[i] = (skg_scale_part){i * 128 + 40, i * 128 + 60, 0, 511, 0, 1.0, 1.0, 1};
    skg_scale scale = find(4, parts, 32);
    ck_assert_double_le(scale.bound, 1 + MARGIN);
    ck_assert_int_eq(scale.bits, 32);
}
END_TEST

START_TEST(what_is_off_the_detector_does_not_count) {
    skg_scale_part parts[2] = {{-900, -100, 0, 511, 0, 1e6, 1, 1}, {10, 20, 10, 20, 5, 6, 1, 1}};
    skg_scale scale = find(2, parts, 32);
    ck_assert_double_ge(scale.bound, 1);
    ck_assert_double_le(scale.bound, 1 + MARGIN);
    scale = find(1, parts, 32);
    ck_assert_double_eq(scale.scale, 1);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, one_part_uses_the_range);
    tcase_add_test(tests, a_laminate_shares_the_range);
    tcase_add_test(tests, a_swarm_needs_64_bits);
    tcase_add_test(tests, parts_side_by_side_do_not_add);
    tcase_add_test(tests, what_is_off_the_detector_does_not_count);
}

SKG_SUITE_MAIN("scale", add_tests)
