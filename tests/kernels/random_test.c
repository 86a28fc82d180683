/* The random numbers of the kernels, compiled as C. */
#include "suite.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

typedef uint32_t uint;

static uint32_t float_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
static float bits_float(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}
static int32_t signed_bits(float x) {
    return (int32_t)float_bits(x);
}
static uint32_t high_half(uint32_t a, uint32_t b) {
    return (uint32_t)((uint64_t)a * b >> 32);
}

/* OpenCL's built-in of the same name. */
#define fma fmaf
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wconversion"
#include "exponential.clh"
#include "random.clh"
SKG_DEFINE_EXP2_FLOAT(power, float, uint32_t, bits_float, float_bits)
SKG_DEFINE_LOG_FLOAT(logarithm, float, int32_t, bits_float, signed_bits, (float))
SKG_DEFINE_PHILOX(philox, uint32_t, high_half)
SKG_DEFINE_ROOT(root, float, uint32_t, bits_float, float_bits)
SKG_DEFINE_NORMAL(normal, float, uint32_t, (float), bits_float, float_bits, logarithm)
SKG_DEFINE_POISSON(poisson, float, uint32_t, int, (float), power, (int))
#pragma GCC diagnostic pop
#undef fma

/* The known answers of the generator's authors (Random123, kat_vectors). */
START_TEST(known_answers) {
    static const uint32_t cases[3][10] = {{0, 0, 0, 0, 0, 0, 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8},
                                          {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff,
                                           0xffffffff, 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd},
                                          {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344, 0xa4093822,
                                           0x299f31d0, 0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}};
    for (int i = 0; i < 3; i++) {
        uint32_t words[4];
        memcpy(words, cases[i], sizeof words);
        philox(words, cases[i][4], cases[i][5]);
        ck_assert_mem_eq(words, cases[i] + 6, sizeof words);
    }
}
END_TEST

START_TEST(square_root) {
    double worst = 0;
    for (uint32_t bits = 0x00800000; bits < 0x7f000000; bits += 9973) {
        const float x = bits_float(bits);
        worst = fmax(worst, fabs((double)root(x) / sqrt((double)x) - 1));
    }
    ck_assert_double_le(worst, 2.5 * (double)FLT_EPSILON);
    ck_assert_double_eq((double)root(0), 0);
}
END_TEST

/* The probability of a greater deviate is that which the bits stand for. */
START_TEST(normal_quantiles) {
    double worst = 0;
    for (uint32_t m = 0; m < 0x7fffffff - 65537; m += m < 4096 ? 1 : 65537) {
        const double p = (m + 0.5) * 0x1p-32, z = (double)normal(m);
        /* An error of z changes p by the density: as an error of z, relative above 1. */
        const double truth = 0.5 * erfc(z / sqrt(2)), density = exp(-z * z / 2) / sqrt(2 * acos(-1));
        worst = fmax(worst, fabs(truth - p) / density / fmax(z, 1));
        ck_assert_double_eq((double)normal(m | 0x80000000), -z);
    }
    ck_assert_double_le(worst, 5e-6); /* the polynomial's 3e-6 */
}
END_TEST

/* Chi-square of counts of photons against the distribution itself. */
static void check_poisson(double mean, uint32_t key) {
    enum { DRAWS = 400000, LIMIT = 200 };
    static int counts[LIMIT];
    double chi = 0, expected = exp(-mean) * DRAWS, left = DRAWS;
    int bins = 0, waiting = 0;
    memset(counts, 0, sizeof counts);
    for (uint32_t i = 0; i < DRAWS / 4; i++) {
        uint32_t words[4] = {i, 1, 2, 3};
        philox(words, key, 0);
        for (int k = 0; k < 4; k++) {
            const int count = (int)poisson((float)mean, words[k]);
            ck_assert(count >= 0 && count < LIMIT);
            counts[count]++;
        }
    }
    double group = 0;
    for (int k = 0; k < LIMIT; k++) {
        group += expected;
        waiting += counts[k];
        left -= expected;
        if (group >= 25 && left >= 25) {
            chi += (waiting - group) * (waiting - group) / group;
            bins++, group = 0, waiting = 0;
        }
        expected *= mean / (k + 1);
    }
    group += fmax(left, 0);
    if (group > 5) chi += (waiting - group) * (waiting - group) / group, bins++;
    /* mean bins - 1, variance twice that: within 4 standard deviations */
    ck_assert_double_le(chi, bins - 1 + 4 * sqrt(2.0 * bins));
}

START_TEST(poisson_counts) {
    check_poisson(0.01, 1);
    check_poisson(0.7, 2);
    check_poisson(5, 3);
    check_poisson(30, 4);
    check_poisson(63.9, 5);
    ck_assert_double_eq((double)poisson(0, 0xffffffff), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, known_answers);
    tcase_add_test(tests, square_root);
    tcase_add_test(tests, normal_quantiles);
    tcase_add_test(tests, poisson_counts);
}

SKG_SUITE_MAIN("random", add_tests)
