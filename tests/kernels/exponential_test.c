/* The exponential and logarithm of the kernels, compiled as C. */
#include "suite.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static int32_t float_bits(float x) {
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
static float bits_float(int32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}
static int64_t double_bits(double x) {
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
static double bits_double(int64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* OpenCL's built-ins of the same names, for numbers alone. */
#define select(a, b, c) ((c) ? (b) : (a))
#define fma(a, b, c) _Generic((a), float: fmaf, default: (fma))(a, b, c)
#define fmin(a, b) ((a) < (b) ? (a) : (b))
#define fmax(a, b) ((a) > (b) ? (a) : (b))
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wconversion"
#include "exponential.clh"
SKG_DEFINE_EXP_FLOAT(exp_minus_float, float, int32_t, bits_float, float_bits, (int32_t))
SKG_DEFINE_EXP_DOUBLE(exp_minus_double, double, int64_t, bits_double, double_bits, (int64_t))
SKG_DEFINE_LOG_FLOAT(log_float, float, int32_t, bits_float, float_bits, (float))
SKG_DEFINE_LOG_DOUBLE(log_double, double, int64_t, bits_double, double_bits, (double))
#pragma GCC diagnostic pop

static double relative(double value, long double truth) {
    return (double)fabsl(((long double)value - truth) / truth);
}

/* Over floats of the reduced interval above 2^-27, every seventh: the bar of the contract is 3e-7. */
START_TEST(exponential_of_reduced_floats) {
    const float limit = 0.34657359f; /* ln 2 / 2 */
    double worst = 0;
    for (int32_t bits = 0x32000000; bits <= float_bits(limit); bits += 7) {
        const float x = bits_float(bits);
        worst = fmax(worst, fabs((double)exp_minus_float(x) * exp((double)x) - 1));
        worst = fmax(worst, fabs((double)exp_minus_float(-x) * exp(-(double)x) - 1));
    }
    ck_assert_double_le(worst, 3e-7);
    ck_assert_double_eq((double)exp_minus_float(0), 1);
}
END_TEST

/* Up to where the result is 0. The argument itself carries 2^-24 of 80; the split keeps the rest small. */
START_TEST(exponential_far_out) {
    double worst = 0, worst_double = 0;
    for (int k = 0; k <= 86900; k++) {
        const float x = (float)k * 1e-3f;
        const double y = k * 8e-3;
        worst = fmax(worst, relative((double)exp_minus_float(x), expl(-(long double)x)));
        worst_double = fmax(worst_double, relative(exp_minus_double(y), expl(-(long double)y)));
    }
    ck_assert_double_le(worst, 3e-7);
    ck_assert_double_le(worst_double, 4 * 2.3e-16);
    ck_assert_double_eq((double)exp_minus_float(88), 0);
    ck_assert_double_eq((double)exp_minus_float(1e30f), 0);
    ck_assert_double_eq(exp_minus_double(1e5), 0);
}
END_TEST

START_TEST(logarithm) {
    double worst = 0, worst_double = 0;
    for (int k = 1; k < 400000; k++) {
        const double x = exp(-80 + k * 4e-4);
        const float f = (float)x;
        /* relative, but near 1 to the last bit of 1 - x */
        worst = fmax(worst, (double)fabsl((long double)log_float(f) - logl((long double)f)) /
                                fmax(fabs(log((double)f)), 1e-3));
        worst_double = fmax(worst_double, (double)fabsl((long double)log_double(x) - logl((long double)x)) /
                                              fmax(fabs(log(x)), 1e-3));
    }
    ck_assert_double_le(worst, 4 * 6e-8);
    ck_assert_double_le(worst_double, 4 * 1.2e-16);
    ck_assert_double_eq((double)log_float(1), 0);
    ck_assert_double_eq(log_double(1), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, exponential_of_reduced_floats);
    tcase_add_test(tests, exponential_far_out);
    tcase_add_test(tests, logarithm);
}

SKG_SUITE_MAIN("exponential", add_tests)
