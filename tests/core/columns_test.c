/* Numbers and columns of text files, whatever the locale. */
#include "core/files.h"
#include "suite.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static double number(const char *text, const char *rest) {
    const char *end = NULL;
    double value = skg_read_number(text, &end);
    ck_assert_str_eq(end, rest);
    return value;
}

START_TEST(numbers) {
    ck_assert_double_eq(number("0.1", ""), 0.1); /* short decimals are exact */
    ck_assert_double_eq(number(" -12.5e-3x", "x"), -12.5e-3);
    ck_assert_double_eq(number("1e22", ""), 1e22);
    ck_assert_double_eq(number("1.e2", ""), 100);
    ck_assert_double_eq(number(".5", ""), 0.5);
    ck_assert_double_eq(number("3e", "e"), 3);
    ck_assert_double_eq(number("3e+", "e+"), 3);
    ck_assert_double_eq(number("-", "-"), 0);
    ck_assert_double_eq(number(".", "."), 0);
    ck_assert_double_eq(number("nan", "nan"), 0);
    ck_assert_double_eq(number("0x10", "x10"), 0);
    ck_assert_double_infinite(number("1e999999999999", ""));
    ck_assert_double_eq(number("1e-999999999999", ""), 0);
    /* Thirty digits: the nearest double or its neighbour. */
    ck_assert_double_eq_tol(number("123456789012345678901234567890", ""), 123456789012345678901234567890.0,
                            1e15);
    uint64_t state = 1;
    for (int i = 0; i < 20000; i++) { /* 17 digits come back within one unit in the last place */
        char text[64];
        state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        double value = ldexp((double)(state >> 11), (int)(state >> 3) % 100 - 100);
        snprintf(text, sizeof text, "%.17g", value);
        ck_assert_double_le(fabs(number(text, "") - value), value * DBL_EPSILON);
    }
}
END_TEST

static const struct {
    const char *text, *says;
} bad[] = {
    {"1 2\n3\n", "line 2: two numbers"},      {"1 2\n3 4 5\n", "line 2: there are more"},
    {"# only\n", "no line with two numbers"}, {"1 2\nEnergy 3\n", "line 2: two numbers"},
    {"12\n", "line 1: two numbers"},          {"1 nan\n", "line 1: two numbers"},
};

START_TEST(columns_that_are_none) {
    char path[] = "/tmp/skg_columns_XXXXXX";
    double *first = NULL, *second = NULL;
    int64_t count = 0;
    int file = mkstemp(path);
    ck_assert_int_eq(write(file, bad[_i].text, strlen(bad[_i].text)), (int)strlen(bad[_i].text));
    close(file);
    ck_skg_fails(skg_read_columns(path, NULL, &count, &first, &second), SKG_ERR_FORMAT, bad[_i].says);
    ck_assert_ptr_null(first);
    ck_assert_ptr_null(second);
    unlink(path);
}
END_TEST

START_TEST(long_files) {
    char path[] = "/tmp/skg_columns_XXXXXX";
    double *first = NULL, *second = NULL;
    int64_t count = 0;
    FILE *file = fdopen(mkstemp(path), "w");
    for (int i = 0; i < 5000; i++) fprintf(file, "%d.5, %d # note\n", i, 2 * i);
    fclose(file);
    ck_skg(skg_read_columns(path, NULL, &count, &first, &second));
    ck_assert_int_eq(count, 5000);
    ck_assert(first[4999] > 4999.4 && second[4999] > 9997.9);
    skg_free(&first);
    skg_free(&second);
    unlink(path);
    ck_skg_fails(skg_read_columns("/tmp", NULL, &count, &first, &second), SKG_ERR_FILE, "/tmp");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, numbers);
    tcase_add_loop_test(tests, columns_that_are_none, 0, sizeof bad / sizeof *bad);
    tcase_add_test(tests, long_files);
}

SKG_SUITE_MAIN("columns", add_tests)
