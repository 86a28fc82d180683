/* Spectral nodes against the sum over all bins. */
#include "spectral/beam_subject.h"

#include "spectral/compression.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A thorax: mm of what a ray may meet; then a contrast agent and a steel wire. */
static const char *const thorax[] = {"Tissue, Soft (ICRU-44)",
                                     "Bone, Cortical (ICRU-44)",
                                     "Adipose Tissue (ICRU-44)",
                                     "Lung Tissue (ICRU-44)",
                                     "I",
                                     "Fe"};
static const double thick[] = {250, 50, 80, 150, 0.6, 1.5};

/* Worst error over other random lengths than those that the compression has looked at. */
static double worst_of(const subject *s, const skg_compression *c, int draws, uint64_t *random) {
    const skg_polychromatic *beam = &s->beam;
    double worst = 0;
    for (int d = 0; d < draws; d++) {
        double exponent[SUBJECT_BINS] = {0};
        const double all = d % 3 ? 1 : next_random(random);
        for (int32_t m = 0; m < beam->materials; m++) {
            const double length = all * next_random(random) * beam->high[m];
            for (int32_t b = 0; b < beam->bins; b++) exponent[b] += length * s->mu[m * beam->bins + b];
        }
        for (int32_t k = 0; k < beam->sets; k++) {
            double truth = 0, found = 0;
            for (int32_t b = 0; b < beam->bins; b++)
                truth += s->shares[b * beam->sets + k] * exp(-exponent[b]);
            for (int32_t n = 0; n < c->nodes.count; n++)
                found += c->nodes.shares[n * beam->sets + k] * exp(-exponent[c->nodes.bin[n]]);
            worst = fmax(worst, fabs(found - truth) / fmax(truth, 1e-6));
        }
    }
    return worst;
}

static void check_nodes(const subject *s, const skg_compression *c, double tolerance, uint64_t *random) {
    ck_assert_int_gt(c->nodes.count, 0);
    ck_assert_double_le(c->bound, tolerance);
    ck_assert_int_gt(c->verified, 2000);
    for (int32_t n = 0; n < c->nodes.count; n++) {
        ck_assert_int_lt(c->nodes.bin[n], s->beam.bins);
        if (n > 0) ck_assert_int_gt(c->nodes.bin[n], c->nodes.bin[n - 1]);
        for (int32_t k = 0; k < s->beam.sets; k++)
            ck_assert_double_ge(c->nodes.shares[n * s->beam.sets + k], 0);
    }
    ck_assert_double_le(worst_of(s, c, 3000, random), c->bound);
}

START_TEST(targets_of_a_thorax) {
    static subject s;
    skg_compression c;
    uint64_t random = 7;
    take_subject(&s, 150, 4, thorax, thick, 1);
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-4, 0, NULL, &c));
    check_nodes(&s, &c, 1e-4, &random);
    ck_assert_int_le(c.nodes.count, 16);
    skg_nodes_release(&c.nodes);
    take_subject(&s, 150, 6, thorax, thick, 1);
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-4, 0, NULL, &c));
    check_nodes(&s, &c, 1e-4, &random);
    ck_assert_int_le(c.nodes.count, 20);
    skg_nodes_release(&c.nodes);
}
END_TEST

START_TEST(random_scenes) {
    static const char *const names[] = {"Tissue, Soft (ICRU-44)",
                                        "Bone, Cortical (ICRU-44)",
                                        "water",
                                        "Al",
                                        "Ti",
                                        "Fe",
                                        "Cu",
                                        "I",
                                        "Ba",
                                        "Gd",
                                        "Au",
                                        "Pb"};
    static subject s;
    uint64_t random = 100 + (uint64_t)_i;
    const char *chosen[SUBJECT_MATERIALS];
    double most[SUBJECT_MATERIALS];
    const int materials = 1 + (int)(6 * next_random(&random));
    for (int m = 0; m < materials; m++) {
        const int which = (int)(12 * next_random(&random));
        chosen[m] = names[which];
        most[m] = (which < 3 ? 200 : which < 5 ? 20 : 1) * next_random(&random);
    }
    const double kvp = 50 + floor(100 * next_random(&random));
    const double tolerance = pow(10, -2 - 4 * next_random(&random));
    skg_compression c;
    take_subject(&s, kvp, materials, chosen, most, 1 + _i % 2);
    ck_skg(skg_nodes_find(&s.beam, s.mu, tolerance, 0, NULL, &c));
    check_nodes(&s, &c, tolerance, &random);
    skg_nodes_release(&c.nodes);
}
END_TEST

/* Means and variances of two bands: a node has both of a band, or neither. */
START_TEST(pairs_have_the_same_nodes) {
    static subject s;
    skg_compression c;
    uint64_t random = 5;
    double sums[4] = {0};
    const double tolerance = _i ? 1e-4 : 1e-2;
    take_subject(&s, 120, 6, thorax, thick, 4);
    for (int32_t b = 0; b < s.beam.bins; b++) {
        const double mean = s.shares[4 * b], second = s.shares[4 * b + 1];
        const int high = b > s.beam.bins / 2;
        for (int k = 0; k < 4; k++)
            sums[k] += s.shares[4 * b + k] = k % 2 == high ? (k < 2 ? mean : second) : 0;
    }
    for (int32_t k = 0; k < 4 * s.beam.bins; k++) s.shares[k] /= sums[k % 4];
    s.beam.paired = 1;
    ck_skg(skg_nodes_find(&s.beam, s.mu, tolerance, 0, NULL, &c));
    check_nodes(&s, &c, tolerance, &random);
    for (int32_t n = 0; n < c.nodes.count; n++)
        for (int k = 0; k < 2; k++)
            ck_assert((c.nodes.shares[4 * n + k] > 0) == (c.nodes.shares[4 * n + 2 + k] > 0));
    skg_nodes_release(&c.nodes);
}
END_TEST

START_TEST(twice_the_same) {
    static subject s;
    skg_compression a, b;
    take_subject(&s, 120, 6, thorax, thick, 2);
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-3, 0, NULL, &a));
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-3, 0, NULL, &b));
    ck_assert_int_eq(a.nodes.count, b.nodes.count);
    ck_assert_mem_eq(a.nodes.bin, b.nodes.bin, (size_t)a.nodes.count * sizeof *a.nodes.bin);
    ck_assert_mem_eq(a.nodes.shares, b.nodes.shares, 2 * (size_t)a.nodes.count * sizeof *a.nodes.shares);
    skg_nodes_release(&a.nodes);
    skg_nodes_release(&b.nodes);
}
END_TEST

/* Bins that count for nothing, a set that counts nothing at all, and a range without any length. */
START_TEST(emptiness) {
    static subject s;
    skg_compression c;
    uint64_t random = 3;
    take_subject(&s, 100, 2, thorax, thick, 2);
    for (int32_t b = 0; b < s.beam.bins; b++) {
        s.shares[2 * b + 1] = 0;
        if (b % 3 == 1) s.shares[2 * b] = 0;
    }
    double sum = 0;
    for (int32_t b = 0; b < s.beam.bins; b++) sum += s.shares[2 * b];
    for (int32_t b = 0; b < s.beam.bins; b++) s.shares[2 * b] /= sum;
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-4, 0, NULL, &c));
    check_nodes(&s, &c, 1e-4, &random);
    for (int32_t n = 0; n < c.nodes.count; n++) ck_assert_double_eq(c.nodes.shares[2 * n + 1], 0);
    skg_nodes_release(&c.nodes);
    s.high[0] = s.high[1] = 0;
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-4, 0, NULL, &c));
    check_nodes(&s, &c, 1e-4, &random);
    skg_nodes_release(&c.nodes);
}
END_TEST

/* Below what double can resolve there is nothing to find, and no bound is claimed. */
START_TEST(nothing_beyond_rounding) {
    static subject s;
    skg_compression c;
    take_subject(&s, 60, 2, thorax, thick, 1);
    ck_skg(skg_nodes_find(&s.beam, s.mu, 1e-17, 0, NULL, &c));
    ck_assert_int_eq(c.nodes.count, 0);
    ck_assert_int_eq(c.verified, 0);
    skg_nodes_release(&c.nodes);
}
END_TEST

/* By hand: of (1, 0), (0, 1) and (1, 1) towards (2, -1) only the first is of use: x = 2, 1 is left. */
START_TEST(least_squares_by_hand) {
    static const double a[6] = {1, 0, 0, 1, 1, 1};
    static const int32_t all[3] = {0, 1, 2};
    skg_least_squares system = {0}, reduced = {0};
    double x[3] = {0}, spread[2];
    ck_skg(skg_least_squares_create(2, 3, &system));
    memcpy(system.a, a, sizeof a);
    system.b[0] = 2, system.b[1] = -1;
    ck_assert_double_eq_tol(skg_nnls(&system, 3, all, 0, x), 1, 32 * DBL_EPSILON);
    ck_assert_double_eq_tol(x[0], 2, 32 * DBL_EPSILON);
    ck_assert_double_eq(x[1], 0);
    ck_assert_double_eq(x[2], 0);
    ck_assert_double_eq_tol(skg_least_squares_solve(&system, 2, all + 1, x, spread), 0, 32 * DBL_EPSILON);
    ck_assert_double_eq_tol(x[0], -3, 32 * DBL_EPSILON); /* (0, 1) and (1, 1): 2 (1, 1) - 3 (0, 1) */
    ck_assert_double_eq_tol(x[1], 2, 32 * DBL_EPSILON);
    ck_assert_double_eq_tol(spread[0], 2, 32 * DBL_EPSILON); /* (A^T A)^-1 = [2 -1; -1 1] */
    ck_assert_double_eq_tol(spread[1], 1, 32 * DBL_EPSILON);
    ck_skg(skg_least_squares_reduce(&system, &reduced));
    x[0] = x[1] = x[2] = 1;
    ck_assert_double_eq_tol(skg_nnls(&reduced, 3, all, 0, x), 1, 32 * DBL_EPSILON);
    ck_assert_double_eq_tol(x[0], 2, 32 * DBL_EPSILON);
    skg_least_squares_release(&system);
    skg_least_squares_release(&reduced);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, targets_of_a_thorax);
    tcase_add_loop_test(tests, random_scenes, 0, 20);
    tcase_add_loop_test(tests, pairs_have_the_same_nodes, 0, 2);
    tcase_add_test(tests, twice_the_same);
    tcase_add_test(tests, emptiness);
    tcase_add_test(tests, nothing_beyond_rounding);
    tcase_add_test(tests, least_squares_by_hand);
}

SKG_SUITE_MAIN("nodes", add_tests)
