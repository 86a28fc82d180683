/* Overlaps of solids whose overlap is known. */
#include "geometry/overlaps.h"
#include "suite.h"
#include "support/random.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Axis-aligned boxes as solids. */
typedef struct {
    double at[24];
} box;

static const int32_t box_corners[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                        2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

static skg_solid make_box(box *store, double x0, double x1, double y0, double y1, double z0, double z1,
                          int64_t inside) {
    for (int v = 0; v < 8; v++) {
        store->at[3 * v] = v & 1 ? x1 : x0;
        store->at[3 * v + 1] = v & 2 ? y1 : y0;
        store->at[3 * v + 2] = v & 4 ? z1 : z0;
    }
    return (skg_solid){
        .vertices = 8, .triangles = 12, .positions = store->at, .corners = box_corners, .inside = inside};
}

START_TEST(overlapping_boxes_are_measured) {
    box store[3];
    skg_solid solids[3];
    solids[0] = make_box(&store[0], 0, 100, 0, 100, 0, 100, -1);
    solids[1] = make_box(&store[1], 60, 140, 0, 100, 30, 70, -1);
    solids[2] = make_box(&store[2], -50, -10, 0, 100, 0, 100, -1);
    int64_t side = 0, count = 0;
    skg_overlap_pair *pairs = NULL;
    ck_skg(skg_overlaps_find(3, solids, &side, &count, &pairs));
    ck_assert_int_eq(count, 1);
    ck_assert_int_eq(pairs[0].kind, SKG_OVERLAP_SIBLINGS);
    ck_assert_int_eq(pairs[0].part, 0);
    ck_assert_int_eq(pairs[0].other, 1);
    /* 40 x 100 x 40 mm; one row of columns at each of four sides: 2 * (1/40 + 1/100) of the grid's 0.75 mm
     * cells */
    ck_assert_double_eq_tol(pairs[0].volume, 160000, 160000 * 0.06);
    ck_assert_double_eq_tol(pairs[0].longest, 40, 16 * DBL_EPSILON * 40);
    ck_assert_double_eq_tol(pairs[0].place[2], 50, 16 * DBL_EPSILON * 50);
    skg_free(&pairs);
}
END_TEST

/* The second box is mirrored in x, so that its triangles face inward; it has a child. */
START_TEST(a_mirrored_box_is_no_other) {
    box store[3];
    skg_solid solids[3];
    solids[0] = make_box(&store[0], 0, 100, 0, 100, 0, 100, -1);
    solids[1] = make_box(&store[1], 140, 60, 0, 100, 30, 70, -1);
    solids[1].inward = 1;
    solids[2] = make_box(&store[2], 110, 130, 20, 80, 40, 60, 1);
    int64_t side = 0, count = 0;
    skg_overlap_pair *pairs = NULL;
    ck_skg(skg_overlaps_find(3, solids, &side, &count, &pairs));
    ck_assert_int_eq(count, 1);
    ck_assert_int_eq(pairs[0].kind, SKG_OVERLAP_SIBLINGS);
    ck_assert_double_eq_tol(pairs[0].volume, 160000, 160000 * 0.06); /* as above */
    skg_free(&pairs);
}
END_TEST

START_TEST(a_child_that_leaves_its_parent_is_reported) {
    box store[3];
    skg_solid solids[3];
    solids[0] = make_box(&store[0], 0, 100, 0, 100, 0, 100, -1);
    solids[1] = make_box(&store[1], 20, 80, 20, 80, 50, 130, 0);
    solids[2] = make_box(&store[2], 25, 75, 25, 75, 60, 90, 1); /* well inside its parent: silent */
    int64_t side = 0, count = 0;
    skg_overlap_pair *pairs = NULL;
    ck_skg(skg_overlaps_find(3, solids, &side, &count, &pairs));
    ck_assert_int_eq(count, 1);
    ck_assert_int_eq(pairs[0].kind, SKG_OVERLAP_PROTRUDES);
    ck_assert_int_eq(pairs[0].part, 1);
    ck_assert_int_eq(pairs[0].other, 0);
    ck_assert_double_eq_tol(pairs[0].longest, 30, 16 * DBL_EPSILON * 30);
    skg_free(&pairs);
}
END_TEST

START_TEST(touching_boxes_do_not_overlap) {
    box store[2];
    skg_solid solids[2];
    solids[0] = make_box(&store[0], 0, 100, 0, 100, 0, 50, -1);
    solids[1] = make_box(&store[1], 0, 100, 0, 100, 50, 100, -1);
    int64_t side = 0, count = 7;
    skg_overlap_pair *pairs = NULL;
    ck_skg(skg_overlaps_find(2, solids, &side, &count, &pairs));
    ck_assert_int_eq(count, 0);
    skg_free(&pairs);
}
END_TEST

/* Bands of rows, with and without the rows that triangles meet, together have what the whole has. */
START_TEST(bands_find_the_same_hits_in_the_same_order) {
    static const int64_t heights[] = {40, 8, 1};
    box store[3];
    skg_solid solids[3];
    skg_columns whole = {.side = 40, .rows = 40};
    skg_column_rows *rows = NULL;
    solids[0] = make_box(&store[0], 0, 100, 0, 100, 0, 100, -1);
    solids[1] = make_box(&store[1], 20, 80, 20, 80, 50, 130, 0);
    solids[2] = make_box(&store[2], 25, 75, 25, 75, 60, 90, 1);
    skg_columns_bound(&whole, 3, solids);
    ck_skg(skg_columns_gather(&whole, 3, solids, NULL));
    ck_assert_int_gt(whole.first[1600], 0);
    ck_skg(skg_columns_span(&whole, 3, solids, &rows));
    for (int k = 0; k < 6; k++)
        for (int64_t row = 0; row < 40; row += heights[k / 2]) {
            skg_columns band = whole;
            band.first_row = row, band.rows = heights[k / 2];
            ck_skg(skg_columns_gather(&band, 3, solids, k % 2 ? rows : NULL));
            const int64_t *first = whole.first + 40 * row;
            for (int64_t cell = 0; cell <= 40 * band.rows; cell++)
                ck_assert_int_eq(band.first[cell], first[cell] - first[0]);
            ck_assert_mem_eq(band.hits, whole.hits + first[0],
                             (size_t)band.first[40 * band.rows] * sizeof *band.hits);
            skg_columns_free(&band);
        }
    skg_free(&rows);
    skg_columns_free(&whole);
}
END_TEST

/* Boxes within each other, of which three contradict their parents, and a column's worth of siblings. All pairs of active parts
 * at each hit, as they once were compared, would be 10^11 comparisons a column. */
START_TEST(thousands_of_nested_boxes_are_swept) {
    enum { BOXES = 4000, PUSHED = 1700 };
    static box store[BOXES];
    static skg_solid solids[BOXES];
    int64_t side = 0, count = 0;
    double hits = 0;
    skg_overlap_pair *pairs = NULL;
    for (int n = 0; n < BOXES; n++) {
        const double half = 100 - 99.0 * n / BOXES, up = n == PUSHED ? 0.03 : 0;
        solids[n] = make_box(&store[n], -half, half, -half, half, up - half, up + half, n - 1);
        hits += 2 * half * half / 1e4; /* of a column, on average */
    }
    ck_skg(skg_overlaps_find(BOXES, solids, &side, &count, &pairs));
    ck_assert_int_lt(side, SKG_OVERLAP_SIDE);
    ck_assert_double_le(hits * (double)(side * side), 1e7);
    ck_assert_double_gt(hits * (double)((side + 16) * (side + 16)), 1e7);
    /* A box that is pushed up by more than the gap of 0.02475 mm leaves its parent above, and is left by its child below. */
    ck_assert_int_eq(count, 2);
    const double half = 100 - 99.0 * PUSHED / BOXES, by = 0.03 - 99.0 / BOXES;
    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(pairs[k].kind, SKG_OVERLAP_PROTRUDES);
        ck_assert_int_eq(pairs[k].other, pairs[k].part - 1);
        ck_assert(pairs[k].part == PUSHED || pairs[k].part == PUSHED + 1);
        ck_assert_double_eq_tol(pairs[k].longest, by, 64 * DBL_EPSILON * 100);
        /* One row of columns at each of four sides, of 16 x 16 to 256 x 256 over 200 mm. */
        ck_assert_double_eq_tol(pairs[k].volume, 4 * half * half * by,
                                4 * 2 * half * 200.0 / (double)side * by);
    }
    skg_free(&pairs);
}
END_TEST

/* Pairs of the sweep, against all pairs at each stretch, in random boxes that overlap, are nested and leave their parents. */
START_TEST(pairs_are_those_of_all_against_all) {
    enum { BOXES = 24 };
    box store[BOXES];
    skg_solid solids[BOXES];
    uint64_t seed = 3;
    for (int turn = 0; turn < 20; turn++) {
        double low[BOXES][3], high[BOXES][3];
        int64_t side = 0, count = 0, expected = 0;
        skg_overlap_pair *pairs = NULL;
        for (int n = 0; n < BOXES; n++) {
            for (int k = 0; k < 3; k++)
                low[n][k] = draw(&seed, -100, 60), high[n][k] = low[n][k] + draw(&seed, 20, 90);
            solids[n] = make_box(&store[n], low[n][0], high[n][0], low[n][1], high[n][1], low[n][2],
                                 high[n][2], n ? draw_below(&seed, n + 1) - 1 : -1);
        }
        ck_skg(skg_overlaps_find(BOXES, solids, &side, &count, &pairs));
        ck_assert_int_eq(side, SKG_OVERLAP_SIDE);
        for (int p = 0; p < BOXES; p++)
            for (int q = 0; q < p; q++) {
                double common = 1, whole = 1, volume = 0;
                for (int k = 0; k < 3; k++) {
                    const double edge = fmin(high[p][k], high[q][k]) - fmax(low[p][k], low[q][k]);
                    common *= fmax(0, edge);
                    whole *= high[p][k] - low[p][k];
                }
                const int siblings = solids[p].inside == solids[q].inside, child = solids[p].inside == q;
                const double truth = siblings ? common : child ? whole - common : 0;
                for (int64_t k = 0; k < count; k++)
                    if ((siblings && pairs[k].part == q && pairs[k].other == p) ||
                        (child && pairs[k].part == p && pairs[k].other == q))
                        volume = pairs[k].volume;
                /* Two rows of columns of 1.2 mm at the sides of bodies of at most 90 mm, in each direction. */
                ck_assert_double_eq_tol(volume, truth, 4 * 1.2 * 90 * 90);
                expected += volume > 0;
            }
        ck_assert_int_eq(count, expected);
        skg_free(&pairs);
    }
}
END_TEST

START_TEST(nothing_is_no_failure) {
    int64_t side = 0, count = 7;
    skg_overlap_pair *pairs = NULL;
    skg_solid none = {.inside = -1};
    ck_skg(skg_overlaps_find(1, &none, &side, &count, &pairs));
    ck_assert_int_eq(count, 0);
    skg_free(&pairs);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, overlapping_boxes_are_measured);
    tcase_add_test(tests, a_mirrored_box_is_no_other);
    tcase_add_test(tests, a_child_that_leaves_its_parent_is_reported);
    tcase_add_test(tests, touching_boxes_do_not_overlap);
    tcase_add_test(tests, bands_find_the_same_hits_in_the_same_order);
    tcase_add_test(tests, thousands_of_nested_boxes_are_swept);
    tcase_add_test(tests, pairs_are_those_of_all_against_all);
    tcase_add_test(tests, nothing_is_no_failure);
}

SKG_SUITE_MAIN("overlap", add_tests)
