/* Rotations, rigid fits and eigenvectors. */
#include "body/rigid.h"
#include "core/eigen.h"
#include "suite.h"
#include "support/random.h"

#include <float.h>
#include <math.h>
#include <string.h>

START_TEST(rotations_and_fits) {
    double r[9], point[5][3] = {{1, 2, 3}, {-4, 0, 2}, {7, -3, 1}, {0, 5, -6}, {2, 2, 9}}, moved[5][3];
    const double vector[3] = {0.3, -0.5, 1.1};
    skg_rotation(vector, r);
    double det = 0;
    for (int k = 0; k < 3; k++)
        det += r[k] * (r[3 + (k + 1) % 3] * r[6 + (k + 2) % 3] - r[3 + (k + 2) % 3] * r[6 + (k + 1) % 3]);
    ck_assert_double_eq_tol(det, 1, 4 * DBL_EPSILON);
    skg_rigid rigid = {.centre = {1, -2, 5}, .shift = {3, 4, -1}}, fit;
    memcpy(rigid.rotation, r, sizeof r);
    for (int i = 0; i < 5; i++) skg_rigid_displace(&rigid, point[i], moved[i]);
    skg_rigid_fit(5, point[0], moved[0], &fit);
    for (int k = 0; k < 9; k++) ck_assert_double_eq_tol(fit.rotation[k], r[k], 32 * DBL_EPSILON);
    for (int i = 0; i < 5; i++) {
        double d[3];
        skg_rigid_displace(&fit, point[i], d);
        for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(d[k], moved[i][k], 64 * DBL_EPSILON * 5);
    }
}
END_TEST

/* Also of matrices larger than a body needs: n = 1 to 8. Beside the vectors stand numbers that must stay. */
START_TEST(eigenvectors_of_any_size) {
    enum { LIMIT = 8 };
    const int n = _i;
    double a[LIMIT * LIMIT] = {0}, matrix[LIMIT * LIMIT], values[LIMIT], v[LIMIT * LIMIT + 1];
    uint64_t state = 5;
    v[n * n] = 42;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) a[n * i + j] = a[n * j + i] = draw(&state, -1, 1);
    memcpy(matrix, a, sizeof a);
    skg_eigen(n, matrix, values, v);
    ck_assert_double_eq(v[n * n], 42);
    for (int k = 0; k < n; k++) {
        if (k > 0) ck_assert_double_ge(values[k - 1], values[k]);
        for (int i = 0; i < n; i++) {
            double sum = 0, product = 0; /* A v, and v of one row times v of another */
            for (int j = 0; j < n; j++) {
                sum += a[n * i + j] * v[n * k + j];
                product += v[n * k + j] * v[n * i + j];
            }
            /* The entries are below 1, and a rotation rounds a few times: 12 sweeps of n (n - 1) / 2, most of them of zeros. */
            ck_assert_double_eq_tol(sum, values[k] * v[n * k + i], 64 * n * DBL_EPSILON);
            ck_assert_double_eq_tol(product, i == k, 64 * n * DBL_EPSILON);
        }
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, rotations_and_fits);
    tcase_add_loop_test(tests, eigenvectors_of_any_size, 1, 9);
}

SKG_SUITE_MAIN("rigid", add_tests)
