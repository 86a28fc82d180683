/* Planes: which materials are mixtures of others. */
#include "spectral/beam_subject.h"

#include "spectral/compression.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const char *const names[] = {"Tissue, Soft (ICRU-44)",
                                    "Adipose Tissue (ICRU-44)",
                                    "Bone, Cortical (ICRU-44)",
                                    "Lung Tissue (ICRU-44)",
                                    "Blood, Whole (ICRU-44)",
                                    "Muscle, Skeletal (ICRU-44)",
                                    "Brain, Grey/White Matter (ICRU-44)",
                                    "Breast Tissue (ICRU-44)",
                                    "I",
                                    "Fe"};
static const double most[] = {200, 60, 40, 150, 60, 60, 50, 60, 0.5, 1.5};

/* Points of the range, and the weights of the bins over them. */
static void weigh_points(const subject *s, int64_t corners, int64_t draws, skg_lengths *points,
                         double weight[SUBJECT_BINS]) {
    const skg_sampling sampling = {.corners = corners, .draws = draws, .seed = 5};
    ck_skg(skg_lengths_fill(&s->beam, &sampling, &(skg_rays){0}, points));
    ck_skg(skg_basis_weigh(&s->beam, points, weight));
}

/* Errors with 1 to `materials` planes, in error[planes]. */
static void find_errors(const subject *s, int32_t first, double *error) {
    const int32_t materials = s->beam.materials;
    skg_lengths points = {0};
    int32_t order[SUBJECT_MATERIALS];
    double weight[SUBJECT_BINS];
    weigh_points(s, 32, 100, &points, weight);
    ck_skg(skg_basis_order(&s->beam, weight, first, order));
    if (first >= 0) ck_assert_int_eq(order[0], first);
    for (int32_t planes = 1; planes <= materials; planes++) {
        skg_basis basis;
        ck_skg(skg_basis_make(&s->beam, &points, weight, order, planes, &basis));
        for (int32_t k = 0; k < planes; k++) {
            const int32_t own = basis.material[k];
            ck_assert_int_eq(own, order[k]);
            for (int32_t j = 0; j < planes; j++)
                ck_assert_double_eq(basis.mix[own * planes + j], j == k ? 1 : 0);
        }
        error[planes] = basis.error;
        skg_basis_release(&basis);
    }
    skg_lengths_release(&points);
}

START_TEST(eight_tissues_need_three_planes) {
    static subject s;
    double error[SUBJECT_MATERIALS + 1];
    take_subject(&s, 150, 8, names, most, 1);
    find_errors(&s, -1, error);
    ck_assert_double_gt(error[1], 1e-3);
    /* The promise of three planes, 1e-4. */
    ck_assert_double_lt(error[3], 1e-4);
    ck_assert_double_lt(error[8], 1e-13); /* each its own: rounding of 150 terms of 1e-16 */
}
END_TEST

START_TEST(iodine_and_steel_need_two_more) {
    static subject s;
    double error[SUBJECT_MATERIALS + 1];
    take_subject(&s, 150, 10, names, most, 1);
    find_errors(&s, -1, error);
    ck_assert_double_gt(error[3], 1e-4);
    /* The promise of five planes, 1e-4. */
    ck_assert_double_lt(error[5], 1e-4);
    find_errors(&s, 3, error); /* lung has to be one */
    ck_assert_double_lt(error[6], 1e-4);
}
END_TEST

/* A third material made of the other two is found to be just that. */
START_TEST(mixture_is_recognised) {
    static subject s;
    skg_lengths points = {0};
    skg_basis basis;
    double weight[SUBJECT_BINS];
    static const int32_t order[] = {0, 2, 1};
    take_subject(&s, 120, 3, names, most, 1);
    for (int32_t b = 0; b < s.beam.bins; b++)
        s.mu[s.beam.bins + b] = 0.75 * s.mu[b] + 0.125 * s.mu[2 * s.beam.bins + b];
    weigh_points(&s, 8, 50, &points, weight);
    ck_skg(skg_basis_make(&s.beam, &points, weight, order, 2, &basis));
    ck_assert_double_eq_tol(basis.mix[2], 0.75, 256 * DBL_EPSILON);
    ck_assert_double_eq_tol(basis.mix[3], 0.125, 256 * DBL_EPSILON);
    ck_assert_double_lt(basis.error, 1e-11); /* exponents up to 80, 1e-14 each */
    skg_basis_release(&basis);
    skg_lengths_release(&points);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, eight_tissues_need_three_planes);
    tcase_add_test(tests, iodine_and_steel_need_two_more);
    tcase_add_test(tests, mixture_is_recognised);
}

SKG_SUITE_MAIN("basis", add_tests)
