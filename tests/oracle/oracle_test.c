/* Random closed solids under random views against the ray caster, by the bars of docs/numerics.md#precision. */
#include "suite.h"
#include "support/random.h"
#include "support/verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Three axes at right angles, anyhow (from a random unit quaternion). */
static void turn_anyhow(uint64_t *seed, double axes[3][3]) {
    double q[4], size = 0;
    do {
        size = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = draw(seed, -1, 1);
            size += q[k] * q[k];
        }
    } while (size > 1 || size < 0.1);
    for (int k = 0; k < 4; k++) q[k] /= sqrt(size);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(axes, m, sizeof m);
}

/* A detector anywhere, turned anyhow, its steps of unequal length and up to 20 degrees from square; a source
 * up to 50 degrees off its normal. distance: mm from source to the detector's centre. */
static skg_view view_anyhow(uint64_t *seed, int64_t columns, int64_t rows, double *distance) {
    skg_view view;
    double axes[3][3];
    skg_view_init(&view);
    turn_anyhow(seed, axes);
    view.projection = (int32_t)draw_below(seed, 3);
    view.columns = columns;
    view.rows = rows;
    const double pitch = 400 / (double)columns * draw(seed, 0.5, 1.5), uneven = draw(seed, 0.7, 1.4);
    const double lean = draw(seed, -0.36, 0.36), off = draw(seed, 0, 1.2), turn = draw(seed, 0, 6.28);
    *distance = draw(seed, 500, 2000);
    for (int k = 0; k < 3; k++) {
        const double way = axes[2][k] + off * (cos(turn) * axes[0][k] + sin(turn) * axes[1][k]);
        const double size = sqrt(1 + off * off);
        view.centre[k] = draw(seed, -300, 300);
        view.column_step[k] = pitch * axes[0][k];
        view.row_step[k] = pitch * uneven * (axes[1][k] + lean * axes[0][k]);
        view.source[k] = view.projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY
                             ? -way
                             : view.centre[k] + *distance * way / size;
    }
    return view;
}

/* Moves a solid of radius 1 so that its shadow is about `wide` pixels across, somewhere on the detector,
 * whole where that is possible. Half of the solids move by their pose (sometimes mirrored), half by their
 * vertices. */
static void place(uint64_t *seed, const skg_view *view, double distance, double wide, solid *s,
                  double pose[16]) {
    const double t = draw(seed, 0.4, 0.75);
    const double spare_columns = fmax(0, (double)view->columns - wide),
                 spare_rows = fmax(0, (double)view->rows - wide);
    const double c = draw(seed, -0.5, 0.5) * spare_columns, r = draw(seed, -0.5, 0.5) * spare_rows;
    double axes[3][3], pitch = 0, way = 0;
    for (int k = 0; k < 3; k++) {
        pitch += view->column_step[k] * view->column_step[k];
        way += view->source[k] * view->source[k];
    }
    double radius = sqrt(pitch) * wide / 2 * (view->projection == SKG_PROJECTION_POINT ? t : 1);
    radius = fmin(radius, 0.2 * distance); /* stays between source and detector */
    turn_anyhow(seed, axes);
    const double mirror = draw_below(seed, 4) == 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        const double pixel = view->centre[k] + c * view->column_step[k] + r * view->row_step[k];
        const double towards = view->projection == SKG_PROJECTION_POINT ? view->source[k] - pixel
                               : view->projection == SKG_PROJECTION_PARALLEL
                                   ? view->source[k] - view->centre[k]
                                   : -view->source[k] / sqrt(way) * distance;
        for (int n = 0; n < 3; n++) pose[4 * k + n] = axes[n][k] * radius * (n == 0 ? mirror : 1);
        pose[4 * k + 3] = pixel + (1 - t) * towards;
        pose[12 + k] = 0;
    }
    pose[15] = 1;
    if (draw_below(seed, 2)) {
        static const double none[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        for (int k = 0; mirror < 0 && k < 3; k++) pose[4 * k] = -pose[4 * k];
        solid_move(s, pose);
        memcpy(pose, none, sizeof none);
    }
}

static solid solid_anyhow(uint64_t *seed, int detail) {
    static const double box[3] = {0.6, 0.6, 0.6};
    switch (draw_below(seed, 4)) {
    case 0:
        return solid_torus(0.7, 0.3, 2 * detail, detail);
    case 1:
        return solid_shell(1, draw(seed, 0.5, 0.95), 2 * detail, detail);
    case 2:
        return solid_tetrahedra(detail, 0.4, box, draw_bits(seed));
    default:
        return solid_blob(0.8, 2 * detail, detail, draw_bits(seed));
    }
}

/* One picture of one solid; its errors are added. */
static void judge(uint64_t *seed, int64_t columns, int64_t rows, double wide, int detail, int64_t pixels,
                  int32_t precision, verdict *v) {
    double distance = 0, pose[16];
    const skg_view view = view_anyhow(seed, columns, rows, &distance);
    solid s = solid_anyhow(seed, detail);
    place(seed, &view, distance, wide, &s, pose);
    double *got = run_solid(&s, pose, &view, (run_choice){.precision = precision});
    caster *c = caster_create(&s, pose);
    v->single = precision == SKG_PRECISION_SINGLE;
    verdict_cast(v, c, &view, got, window_of(&s, pose, &view), pixels, 0, seed);
    caster_free(c);
    free(got);
    solid_free(&s);
}

/* Many pictures of solids of one size on the detector. */
static void check_size(double wide, int pictures, uint64_t seed) {
    for (int32_t precision = SKG_PRECISION_SINGLE;
         precision <= (run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE); precision++) {
        verdict all = {0};
        char what[64];
        uint64_t state = seed;
        for (int n = 0; n < pictures; n++)
            judge(&state, 512, 480, wide, wide < 20 ? 6 : 24, 300, precision, &all);
        snprintf(what, sizeof what, "solids of %g pixels", wide);
        verdict_check(&all, precision, what);
        verdict_free(&all);
    }
}

START_TEST(specks) {
    check_size(3, 40, 1);
}
END_TEST

START_TEST(small_parts) {
    check_size(12, 30, 2);
}
END_TEST

START_TEST(middling_parts) {
    check_size(80, 24, 3);
}
END_TEST

START_TEST(large_parts) {
    check_size(300, 16, 4);
}
END_TEST

START_TEST(larger_than_the_detector) {
    check_size(700, 12, 5);
}
END_TEST

/* The bars hold for every number of pixels, and the part may stand in a corner. */
START_TEST(large_detectors) {
    uint64_t seed = 6;
    for (int n = 0; n < 6; n++) {
        const int32_t precision =
            n % 3 == 2 && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
        verdict v = {0};
        judge(&seed, n < 3 ? 2048 : 1024, 1536, n % 2 ? 40 : 900, 24, 400, precision, &v);
        verdict_check(&v, precision, "a large detector");
        verdict_free(&v);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, specks);
    tcase_add_test(tests, small_parts);
    tcase_add_test(tests, middling_parts);
    tcase_add_test(tests, large_parts);
    tcase_add_test(tests, larger_than_the_detector);
    tcase_add_test(tests, large_detectors);
}

SKG_SUITE_MAIN("oracle", add_tests)
