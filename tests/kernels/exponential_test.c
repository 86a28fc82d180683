/* The exponential and logarithm of the kernels, compiled as C. */
#include "suite.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

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
static uint64_t double_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
static double bits_double(uint64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}
static int32_t signed_bits(float x) {
    return (int32_t)float_bits(x);
}
static int64_t signed_double_bits(double x) {
    return (int64_t)double_bits(x);
}

/* OpenCL's built-ins of the same names, for numbers alone. */
#define fma(a, b, c) _Generic((a), float : fmaf, default : (fma))(a, b, c)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wconversion"
#include "exponential.clh"
SKG_DEFINE_EXP2_FLOAT(exp2_float, float, uint32_t, bits_float, float_bits)
SKG_DEFINE_EXP2_DOUBLE(exp2_double, double, uint64_t, bits_double, double_bits)
SKG_DEFINE_LOG_FLOAT(log_float, float, int32_t, bits_float, signed_bits, (float))
SKG_DEFINE_LOG_DOUBLE(log_double, double, int64_t, bits_double, signed_double_bits, (double))
#pragma GCC diagnostic pop

static double relative(double value, long double truth) {
    return (double)fabsl(((long double)value - truth) / truth);
}

/* Over floats of the reduced interval above 2^-27, every seventh. docs/numerics.md#attenuation: within 3e-7,
 * which is 2.5 * FLT_EPSILON. */
START_TEST(powers_of_reduced_floats) {
    double worst = 0;
    for (uint32_t bits = 0x32000000; bits <= float_bits(0.5f); bits += 7) {
        const float x = bits_float(bits);
        worst = fmax(worst, fabs((double)exp2_float(x) * exp2(-(double)x) - 1));
        worst = fmax(worst, fabs((double)exp2_float(-x) * exp2((double)x) - 1));
    }
    ck_assert_double_le(worst, 2.5 * (double)FLT_EPSILON);
    ck_assert_double_eq((double)exp2_float(0), 1);
}
END_TEST

/* The whole part is split off exactly: far out the error is the same. */
START_TEST(powers_far_out) {
    double worst = 0, worst_double = 0;
    for (int k = -1000; k <= 125400; k++) {
        const float x = (float)k * -1e-3f;
        const double y = k * -8e-3;
        worst = fmax(worst, relative((double)exp2_float(x), exp2l((long double)x)));
        worst_double = fmax(worst_double, relative(exp2_double(y), exp2l((long double)y)));
    }
    ck_assert_double_le(worst, 2.5 * (double)FLT_EPSILON);
    ck_assert_double_le(worst_double, 4 * DBL_EPSILON);
    ck_assert_double_eq((double)exp2_float(-126), 0);
    ck_assert_double_eq((double)exp2_float(-1e30f), 0);
    ck_assert_double_eq(exp2_double(-1e5), 0);
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
    ck_assert_double_le(worst, 2 * (double)FLT_EPSILON);
    ck_assert_double_le(worst_double, 2 * DBL_EPSILON);
    ck_assert_double_eq((double)log_float(1), 0);
    ck_assert_double_eq(log_double(1), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, powers_of_reduced_floats);
    tcase_add_test(tests, powers_far_out);
    tcase_add_test(tests, logarithm);
}

SKG_SUITE_MAIN("exponential", add_tests)
