/* Open meshes against the closed ones that they were made from: what is reported, what is left out, and both
 * repairs. */
#include "frame/soup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Terms are rounded to 2^-50 of the longest sum, lengths of rays are 1,200 mm: 1e-9 mm is a thousand
 * roundings. */
static const double DOUBLE_TOLERANCE = 1e-9;

static int sheets; /* pieces that a warning has said to enclose nothing */
static void keep_sheets(int32_t level, const char *message, void *user) {
    const char *of = strstr(message, ": ");
    (void)user;
    if (level == SKG_LOG_WARNING && of && strstr(message, "enclose nothing")) sheets = atoi(of + 2);
}

/* The soup with and without repair against the closed one. change: mm by which neighbours may differ. */
static void check_repairs(const soup *broken, const soup *closed, double change) {
    static picture truth, left_out, neighbours, exact;
    wish w = {.precision = SKG_PRECISION_DOUBLE};
    take(closed, NULL, &w, &truth);
    ck_assert_int_eq(truth.report.leaky_parts, 0);
    w.repair = SKG_REPAIR_NONE;
    take(broken, NULL, &w, &left_out);
    ck_assert_int_gt(left_out.report.bad_pixels, 10);
    ck_assert_int_eq(left_out.report.repaired_pixels, 0);
    ck_assert_int_eq(count_different(&left_out, &truth), left_out.report.bad_pixels);
    w.repair = SKG_REPAIR_NEIGHBOURS;
    take(broken, NULL, &w, &neighbours);
    ck_assert_int_eq(neighbours.report.bad_pixels, left_out.report.bad_pixels);
    ck_assert_int_eq(neighbours.report.repaired_pixels, left_out.report.bad_pixels);
    ck_assert_double_le(worst(&neighbours, &truth), change);
    w.repair = SKG_REPAIR_EXACT;
    take(broken, NULL, &w, &exact);
    ck_assert_int_eq(exact.report.repaired_pixels, left_out.report.bad_pixels);
    ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
}

/* Within half the radius a sphere's length changes by 2 rho / sqrt(R^2 - rho^2) <= 1.155 mm per mm; a
 * triangle of this one has edges below 11 mm, so the nearest pixels outside it lie within 11 mm, and a
 * square's corners sqrt(2) further. */
static const double NEIGHBOURS_CHANGE = 1.155 * 1.4142 * 11;

START_TEST(a_missing_triangle) {
    static soup closed, broken;
    fill_sphere(&closed);
    broken = closed;
    remove_triangle(&broken, triangle_at(&broken, 5, 3, -40));
    check_repairs(&broken, &closed, NEIGHBOURS_CHANGE);
}
END_TEST

START_TEST(a_flipped_triangle) {
    static soup closed, broken;
    fill_sphere(&closed);
    broken = closed;
    flip_triangle(&broken, triangle_at(&broken, -4, 8, 40));
    check_repairs(&broken, &closed, NEIGHBOURS_CHANGE);
}
END_TEST

/* An edge is halved on one side only, 2 mm beside its middle: the gap is the triangle that closes it. */
START_TEST(a_t_junction) {
    static soup closed, broken;
    fill_sphere(&broken);
    const int64_t t = triangle_at(&broken, 9, 2, -38);
    const int32_t a = broken.corners[3 * t], b = broken.corners[3 * t + 1], c = broken.corners[3 * t + 2];
    const int32_t middle = (int32_t)broken.vertices++;
    for (int k = 0; k < 3; k++) {
        const double *p = broken.positions;
        broken.positions[3 * middle + k] = 0.4 * p[3 * a + k] + 0.4 * p[3 * b + k] + 0.2 * p[3 * c + k];
    }
    const int32_t halves[6] = {a, middle, c, middle, b, c}, gap[3] = {a, b, middle};
    memcpy(broken.corners + 3 * t, halves, 3 * sizeof *halves);
    memcpy(broken.corners + 3 * broken.triangles++, halves + 3, 3 * sizeof *halves);
    closed = broken;
    memcpy(closed.corners + 3 * closed.triangles++, gap, sizeof gap);
    check_repairs(&broken, &closed, NEIGHBOURS_CHANGE);
}
END_TEST

/* Everything above a plane is cut off: many triangles, one plane loop, seen from the side and from within. */
START_TEST(a_cut) {
    static soup closed, broken;
    static picture truth, exact;
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_EXACT};
    fill_sphere(&broken);
    for (int64_t v = 0; v < broken.vertices;
         v++) { /* rings of the sphere are plane: flatten what is above one */
        double *z = &broken.positions[3 * v + 2];
        if (*z > 15) *z = 20;
    }
    closed = broken;
    for (int64_t t = broken.triangles; t-- > 0;) {
        int above = 0;
        for (int c = 0; c < 3; c++) above += broken.positions[3 * broken.corners[3 * t + c] + 2] > 15;
        if (above == 3) remove_triangle(&broken, t);
    }
    const double places[] = {0, -1000}; /* the second: the source within */
    for (int k = 0; k < 2; k++) {
        w.z[0] = places[k];
        take(&closed, NULL, &w, &truth);
        take(&broken, NULL, &w, &exact);
        ck_assert_int_gt(exact.report.bad_pixels, SIDE);
        ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
    }
}
END_TEST

/* One enters through its hole where the other leaves through its own: one count for both would cancel. */
START_TEST(holes_that_coincide) {
    static soup closed, near, far;
    static picture truth, one, two, exact, neighbours;
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_EXACT, .z = {-60, 60}};
    double mu = 0;
    fill_sphere(&closed);
    near = far = closed;
    remove_triangle(&near, triangle_at(&near, 4, 4, -40));
    remove_triangle(&far, triangle_at(&far, 4, 4, 40));
    take(&closed, &closed, &w, &truth);
    take(&near, &closed, &w, &one);
    take(&closed, &far, &w, &two);
    take(&near, &far, &w, &exact);
    ck_assert_int_gt(one.report.bad_pixels, 10);
    ck_assert_int_gt(two.report.bad_pixels, 10);
    ck_assert_int_eq(exact.report.bad_pixels, one.report.bad_pixels + two.report.bad_pixels);
    ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
    w.repair = SKG_REPAIR_NEIGHBOURS;
    take(&near, &far, &w, &neighbours);
    ck_skg(skg_material_attenuation_get(water, 60, &mu));
    ck_assert_double_le(worst(&neighbours, &truth), 2 * 0.1 * mu * NEIGHBOURS_CHANGE);
}
END_TEST

/* A box of 60 mm with windows of 20 mm in two opposite faces: rays through both meet nothing, and balance.
 * Faces are 3 x 3 squares of 20 mm; vertices are those of a grid of 4 x 4 x 4. */
static void fill_windowed(soup *s, int windows) {
    *s = (soup){.vertices = 64};
    for (int v = 0; v < 64; v++)
        for (int k = 0; k < 3; k++) s->positions[3 * v + k] = -30 + 20.0 * (v >> 2 * k & 3);
    for (int face = 0; face < 54; face++) {
        const int axis = face / 18, side = face / 9 % 2, i = face % 3, j = face / 3 % 3;
        const int u = 1 << 2 * ((axis + 1) % 3), v = 1 << 2 * ((axis + 2) % 3);
        const int32_t at = (int32_t)((side ? 3 << 2 * axis : 0) + i * u + j * v);
        const int32_t along = (int32_t)(side ? u : v), across = (int32_t)(side ? v : u);
        const int32_t two[6] = {at, at + along, at + u + v, at, at + u + v, at + across};
        if (windows && axis == 2 && i == 1 && j == 1) continue;
        memcpy(s->corners + 3 * s->triangles, two, sizeof two);
        s->triangles += 2;
    }
}

/* The box as six plane patches, each `gap` mm outside its face: none has an edge in common with another. */
static void fill_patches(soup *s, double gap) {
    static soup box;
    fill_windowed(&box, 0);
    *s = (soup){.triangles = box.triangles};
    for (int64_t i = 0; i < 3 * box.triangles; i++) {
        const int64_t face = i / 27 / 2, axis = face / 2, side = face % 2, at = s->vertices;
        for (int k = 0; k < 3; k++) s->positions[3 * at + k] = box.positions[3 * box.corners[i] + k];
        s->positions[3 * at + axis] += side ? gap : -gap;
        s->corners[i] = (int32_t)s->vertices++;
    }
}

/* Loops of plane patches would be closed by the patches' own reverse; cracks are bridged first. Wide ones are not, which a warning says. */
START_TEST(plane_patches_that_nobody_welded) {
    static const double gaps[] = {1e-7, 1e-4, 0.02, 1};
    static soup closed, patches;
    static picture truth, exact;
    const double gap = gaps[_i];
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_EXACT};
    int64_t through = 0;
    fill_windowed(&closed, 0);
    fill_patches(&patches, gap);
    take(&closed, NULL, &w, &truth);
    ck_skg(skg_context_log_set(context, keep_sheets, NULL));
    take(&patches, NULL, &w, &exact);
    for (int64_t i = 0; i < SIDE * SIDE; i++) {
        const double mm = truth.mm[i / SIDE][i % SIDE];
        if (mm < 60 || mm > 60.2) continue; /* from the face in front to that behind */
        through++;
        if (gap < 1)
            ck_assert_double_eq_tol(exact.mm[i / SIDE][i % SIDE], mm, 2 * gap * mm / 60 + DOUBLE_TOLERANCE);
    }
    ck_assert_int_gt(through, 1000);
    ck_assert_int_eq(sheets, gap < 1 ? 0 : 6);
}
END_TEST

/* Counts of hits cannot detect such rays: "neighbours" and "none" leave the hole black, "exact" has the full box. */
START_TEST(in_through_one_hole_and_out_through_another) {
    static soup closed, broken;
    static picture truth, left_out, neighbours, exact;
    fill_windowed(&closed, 0);
    fill_windowed(&broken, 1);
    for (int32_t projection = 0; projection < 2; projection++) {
        wish w = {.precision = SKG_PRECISION_DOUBLE};
        view.projection = projection ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        take(&closed, NULL, &w, &truth);
        ck_assert_int_eq(truth.report.leaky_parts, 0);
        ck_assert_double_gt(truth.mm[SIDE / 2][SIDE / 2], 59.9);
        take(&broken, NULL, &w, &left_out);
        w.repair = SKG_REPAIR_NEIGHBOURS;
        take(&broken, NULL, &w, &neighbours);
        w.repair = SKG_REPAIR_EXACT;
        take(&broken, NULL, &w, &exact);
        ck_assert_double_eq(left_out.mm[SIDE / 2][SIDE / 2], 0);
        ck_assert_double_eq(neighbours.mm[SIDE / 2][SIDE / 2], 0);
        ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
        /* bits_test has all of them in parallel beams. */
        for (int32_t strategy = SKG_STRATEGY_COPIES;
             strategy <= SKG_STRATEGY_ATOMICS && (!projection || suite_full()); strategy++) {
            w.strategy = strategy;
            take(&broken, NULL, &w, &left_out);
            ck_assert_mem_eq(left_out.mm, exact.mm, sizeof exact.mm);
        }
        /* Single: the most that a ray may err by anywhere, along the box's sides. */
        wish single = {.repair = SKG_REPAIR_EXACT};
        take(&closed, NULL, &single, &truth);
        take(&broken, NULL, &single, &exact);
        /* mm, see above */
        ck_assert_double_le(worst(&exact, &truth), 1e-3);
    }
}
END_TEST

/* The mean over the border of the smallest square with a valid pixel, by brute force. */
static double neighbours_of(const picture *truth, const picture *left_out, int row, int column) {
    for (int reach = 0;; reach++) {
        double sum = 0;
        int valid = 0;
        for (int r = row - reach; r <= row + reach; r++)
            for (int c = column - reach; c <= column + reach; c++) {
                if (r < 0 || c < 0 || r >= SIDE || c >= SIDE) continue;
                /* mm: as in count_different. */
                if (fabs(left_out->mm[r][c] - truth->mm[r][c]) > 1e-6) continue;
                sum += left_out->mm[r][c];
                valid++;
            }
        if (valid) return sum / valid;
    }
}

START_TEST(neighbours_are_the_means_of_squares) {
    static soup closed, broken;
    static picture truth, left_out, repaired;
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_NONE};
    view.projection =
        SKG_PROJECTION_PARALLEL; /* every ray as long: a mean of path parameters is one of lengths */
    fill_sphere(&closed);
    broken = closed;
    for (int k = 0; k < 9; k++) remove_triangle(&broken, triangle_at(&broken, 20.0 - 5 * k, 3, -40));
    take(&closed, NULL, &w, &truth);
    take(&broken, NULL, &w, &left_out);
    w.repair = SKG_REPAIR_NEIGHBOURS;
    take(&broken, NULL, &w, &repaired);
    ck_assert_int_gt(repaired.report.repaired_pixels, 200);
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++)
            ck_assert_double_eq_tol(repaired.mm[r][c], neighbours_of(&truth, &left_out, r, c),
                                    DOUBLE_TOLERANCE);
}
END_TEST

START_TEST(strategies_agree) {
    static soup broken;
    static picture first, other;
    fill_sphere(&broken);
    for (int k = 0; k < 5; k++) remove_triangle(&broken, triangle_at(&broken, 10.0 - 5 * k, 3, 7 * k - 20));
    for (int32_t repair = SKG_REPAIR_NONE; repair <= SKG_REPAIR_EXACT; repair++)
        for (int32_t strategy = SKG_STRATEGY_COPIES; strategy <= SKG_STRATEGY_ATOMICS; strategy++) {
            const wish w = {.repair = repair, .strategy = strategy};
            picture *taken = strategy == SKG_STRATEGY_COPIES ? &first : &other;
            take(&broken, NULL, &w, taken);
            ck_assert_int_gt(taken->report.bad_pixels, 0);
            if (taken == &other) ck_assert_mem_eq(first.mm, other.mm, sizeof first.mm);
        }
}
END_TEST

/* A sheet before the whole detector: no valid pixel anywhere, and nothing is made up. */
START_TEST(no_valid_pixel) {
    static const soup sheet = {.vertices = 4,
                               .triangles = 2,
                               .positions = {-200, -200, 0, 200, -200, 0, 200, 200, 0, -200, 200, 0},
                               .corners = {0, 1, 2, 0, 2, 3}};
    static picture left;
    const wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_NEIGHBOURS};
    take(&sheet, NULL, &w, &left);
    ck_assert_int_eq(left.report.bad_pixels, SIDE * SIDE);
    ck_assert_int_eq(left.report.repaired_pixels, 0);
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++) ck_assert_double_eq(left.mm[r][c], 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, a_missing_triangle);
    tcase_add_test(tests, a_flipped_triangle);
    tcase_add_test(tests, a_t_junction);
    tcase_add_test(tests, a_cut);
    tcase_add_test(tests, holes_that_coincide);
    tcase_add_loop_test(tests, plane_patches_that_nobody_welded, 0, 4);
    tcase_add_test(tests, in_through_one_hole_and_out_through_another);
    tcase_add_test(tests, neighbours_are_the_means_of_squares);
    tcase_add_test(tests, strategies_agree);
    tcase_add_test(tests, no_valid_pixel);
}

SKG_SUITE_MAIN("repair", add_tests)
