/* Path lengths: watertight, exact, and the same bits from every strategy. */
#include "kernels/picture.h"
#include "suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static skg_context *context;

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
}

static void close_context(void) {
    skg_context_release(&context);
}

static skg_raster_options options_of(int32_t precision, int32_t strategy) {
    return (skg_raster_options){
        .kernels = {.precision = precision, .bits = precision == SKG_PRECISION_DOUBLE ? 64 : 32},
        .strategy = strategy,
        .planes = 1};
}

static double scale_of(const skg_raster_options *options) {
    return options->kernels.bits == 64 ? 0x1p48 : 0x1p28;
}

static picture take(const skg_raster_options *options, const skg_view *view, int bodies, const body *of) {
    picture result;
    ck_skg(picture_take(context, options, view, bodies, of, scale_of(options), &result));
    ck_assert_int_eq(result.bad, INT32_MAX);
    return result;
}

/* Every strategy and shape of tile; returns the number of variants. */
enum { VARIANTS = 7 };
static skg_raster_options variant(const skg_raster_options *of, int number) {
    static const struct {
        int32_t strategy, shape, tile;
    } all[VARIANTS] = {{SKG_STRATEGY_COPIES, 0, 0},
                       {SKG_STRATEGY_ATOMICS, 0, 0},
                       {SKG_STRATEGY_TILES, SKG_TILE_BANDS, 0},
                       {SKG_STRATEGY_TILES, SKG_TILE_BANDS, 1},
                       {SKG_STRATEGY_TILES, SKG_TILE_BANDS, 13},
                       {SKG_STRATEGY_TILES, SKG_TILE_SQUARES, 8},
                       {SKG_STRATEGY_TILES, SKG_TILE_SQUARES, 32}};
    skg_raster_options options = *of;
    options.strategy = all[number].strategy;
    options.shape = all[number].shape;
    options.tile = all[number].tile;
    return options;
}

/* A sphere and two boxes, one of them mirrored, turned and stretched. */
enum { THREE = 3 };
static void three_bodies(const shape *sphere, const shape *box, body bodies[THREE]) {
    for (int b = 0; b < THREE; b++) bodies[b] = body_make(b ? box : sphere, 0);
    const double turned[12] = {-0.8, 0.6, 0, 33.3, 0.6, 0.8, 0, 20, 0.1, 0, 1.5, 0};
    memcpy(bodies[1].pose, turned, sizeof turned);
    bodies[2].pose[3] = -20.123;
    bodies[2].pose[11] = 37;
    bodies[2].weight = 0.25;
}

/* --- bits
 * ---------------------------------------------------------------------------------------------------------
 */

static void check_variants(const skg_raster_options *options, const skg_view *view, int bodies,
                           const body *of) {
    const skg_raster_options reference = variant(options, 0);
    picture first = take(&reference, view, bodies, of);
    for (int v = 1; v < VARIANTS; v++) {
        const skg_raster_options other = variant(options, v);
        picture result = take(&other, view, bodies, of);
        ck_assert_msg(result.hash == first.hash, "variant %d differs (precision %d, parallel %d, source %d)",
                      v, (int)options->kernels.precision, (int)options->kernels.parallel,
                      (int)options->kernels.source_plane);
        picture_free(&result);
    }
    picture_free(&first);
}

START_TEST(strategies_give_the_same_bits) {
    shape sphere = shape_sphere(40, 48, 24), box = shape_box(30, 20, 10);
    body bodies[THREE];
    three_bodies(&sphere, &box, bodies);
    for (int n = 0; n < 6; n++) {
        skg_raster_options options = options_of(n == 1 ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE, 0);
        skg_view view = view_make(75, 49, 1.7);
        if (n == 2) options.kernels.bits = 64;
        options.kernels.seams = n % 2;
        options.kernels.parallel = n == 3;
        options.kernels.source_plane = n >= 3;
        view.projection = n == 3 ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        if (n == 3 || n == 4) view.source[0] = 5, view.source[2] = 10; /* inside the sphere */
        if (options.kernels.precision == SKG_PRECISION_DOUBLE && !context->device->info.double_precision)
            continue;
        check_variants(&options, &view, THREE, bodies);
    }
    shape_free(&sphere);
    shape_free(&box);
}
END_TEST

START_TEST(planes_are_apart) {
    shape sphere = shape_sphere(40, 48, 24), box = shape_box(30, 20, 10);
    body bodies[THREE];
    three_bodies(&sphere, &box, bodies);
    skg_view view = view_make(75, 49, 1.7);
    skg_raster_options options = options_of(SKG_PRECISION_SINGLE, SKG_STRATEGY_COPIES), one = options;
    options.kernels.listed = 1;
    options.planes = THREE;
    for (int b = 0; b < THREE; b++) bodies[b].plane = b;
    check_variants(&options, &view, THREE, bodies);
    picture all = take(&options, &view, THREE, bodies);
    const size_t size = (size_t)(view.columns * view.rows);
    for (int b = 0; b < THREE; b++) { /* a body alone, through the program for one plane */
        body alone = bodies[b];
        alone.plane = 0;
        picture single = take(&one, &view, 1, &alone);
        ck_assert_mem_eq(single.sums, all.sums + (size_t)b * size, size * sizeof *all.sums);
        picture_free(&single);
    }
    picture_free(&all);
    shape_free(&sphere);
    shape_free(&box);
}
END_TEST

START_TEST(order_and_threads_do_not_matter) {
    shape sphere = shape_sphere(60, 128, 64), shuffled = shape_shuffle(&sphere, 3),
          apart = shape_unweld(&sphere);
    const shape *same[3] = {&sphere, &shuffled, &apart};
    skg_view view = view_make(96, 96, 1.5);
    skg_raster_options options = options_of(SKG_PRECISION_SINGLE, SKG_STRATEGY_COPIES);
    uint64_t hash = 0;
    for (int n = 0; n < 4; n++) {
        if (n == 3) {
            close_context();
            if (skg_context_create("threads=1", &context) != SKG_OK) {
                open_context(); /* a device that cannot be parted */
                break;
            }
        }
        body b = body_make(same[n % 3], 0);
        picture result = take(&options, &view, 1, &b);
        if (n == 0) hash = result.hash;
        ck_assert_uint_eq(result.hash, hash);
        picture_free(&result);
    }
    shape_free(&sphere);
    shape_free(&shuffled);
    shape_free(&apart);
}
END_TEST

/* --- no seam --------------------------------------------------------------------------------------------- */

/* Signed hits of a closed shape cancel in every pixel, by copies (wide) and by atomics (scalar), with edges that are moved for
 * coverage and without. */
static void check_cancels(const char *what, const skg_view *view, const shape *s, const double *pose,
                          int32_t source) {
    for (int32_t precision = SKG_PRECISION_SINGLE; precision <= SKG_PRECISION_DOUBLE; precision++) {
        if (precision == SKG_PRECISION_DOUBLE && !context->device->info.double_precision) continue;
        for (int v = 0; v < 4; v++) {
            skg_raster_options options = options_of(precision, 0);
            options.kernels.listed = 1;
            options.kernels.seams = v / 2;
            options.kernels.source_plane = source;
            options.kernels.parallel = view->projection != SKG_PROJECTION_POINT;
            options = variant(&options, v % 2);
            body b = body_make(s, 0);
            b.weight = 0;
            b.bias = 1;
            if (pose) memcpy(b.pose, pose, sizeof b.pose);
            picture counts = take(&options, view, 1, &b);
            int64_t bad = 0;
            for (int64_t p = 0; p < view->rows * view->columns; p++) bad += counts.sums[p] != 0;
            ck_assert_msg(bad == 0, "%s: %d bad pixels (precision %d, variant %d)", what, (int)bad,
                          (int)precision, v);
            picture_free(&counts);
        }
    }
}

START_TEST(corners_within_three_ulps_of_rays) {
    skg_view view = view_make(256, 256, 0.8);
    for (unsigned seed = 1; seed <= 3; seed++) {
        shape s = shape_octahedra(400, seed, &view, 3), apart = shape_unweld(&s);
        check_cancels("octahedra", &view, &s, NULL, 0);
        check_cancels("octahedra, corners not shared", &view, &apart, NULL, 0);
        skg_view parallel = view;
        parallel.projection = SKG_PROJECTION_PARALLEL;
        check_cancels("octahedra, parallel", &parallel, &s, NULL, 0);
        shape_free(&s);
        shape_free(&apart);
    }
}
END_TEST

START_TEST(edges_on_pixel_centres) {
    skg_view view = view_make(65, 65, 1);
    view.projection = SKG_PROJECTION_PARALLEL; /* corners and edges stand exactly on centres */
    shape cube = shape_box(32, 32, 32);
    check_cancels("cube on centres", &view, &cube, NULL, 0);
    skg_raster_options options = options_of(SKG_PRECISION_SINGLE, SKG_STRATEGY_COPIES);
    options.kernels.parallel = 1;
    body b = body_make(&cube, 0);
    picture result = take(&options, &view, 1, &b);
    for (int64_t p = 0; p < 65 * 65;
         p++) { /* half open: the edge of one side counts, that of the other not */
        const int64_t i = p % 65 - 32, j = p / 65 - 32;
        const double expected = i >= -16 && i < 16 && j >= -16 && j < 16 ? 32 : 0;
        ck_assert_double_eq_tol(result.values[p], expected, 32 * 1e-6); /* bits of the scale: 1200 / 2^28 */
    }
    picture_free(&result);
    shape_free(&cube);
}
END_TEST

START_TEST(slivers_and_dust) {
    skg_view view = view_make(128, 128, 1.5);
    const double flat[16] = {1, 0.3, 0, 0, 0, 0.01, 0, 0.2, 0.2, 0, 0.02, 0, 0, 0, 0, 1};
    const double speck[16] = {0.02, 0, 0, 3.1, 0, 0.02, 0, 2.7, 0, 0, 0.02, 0, 0, 0, 0, 1};
    const double giant[16] = {900, 0, 0, 100, 0, 900, 0, 50, 0, 0, 1, 0, 0, 0, 0, 1};
    shape fine = shape_sphere(60, 400, 200), coarse = shape_sphere(60, 16, 8);
    check_cancels("slivers", &view, &fine, flat, 0);
    check_cancels("coarse slivers", &view, &coarse, flat, 0);
    check_cancels("dust", &view, &fine, NULL, 0);
    check_cancels("speck", &view, &fine, speck, 0);
    check_cancels("giant", &view, &coarse, giant, 0);
    shape_free(&fine);
    shape_free(&coarse);
}
END_TEST

START_TEST(source_inside) {
    shape sphere = shape_sphere(60, 48, 24), box = shape_box(80, 60, 500);
    for (int n = 0; n < 6; n++) {
        skg_view view = view_make(80, 80, 2);
        view.source[0] = n * 3.7;
        view.source[1] = n == 5 ? 0 : 1.3;
        view.source[2] = n == 5 ? 0 : -40 + 17 * n;
        check_cancels("source in a sphere", &view, &sphere, NULL, 1);
        check_cancels("box across source and detector", &view, &box, NULL, 1);
    }
    shape_free(&sphere);
    shape_free(&box);
}
END_TEST

/* Turned faces cross the source's plane: of their rows and columns, those on both sides of a gap are hit. */
START_TEST(turned_rods_round_the_source) {
    shape rod = shape_box(9, 7, 300), coarse = shape_sphere(12, 6, 4);
    for (int n = 0; n < 12; n++) {
        skg_view view = view_make(96, 96, 4);
        const double a = 0.5 * n, b = 0.3 + 0.9 * n;
        const double pose[16] = {cos(b),
                                 -sin(b) * cos(a),
                                 sin(b) * sin(a),
                                 0.7,
                                 sin(b),
                                 cos(b) * cos(a),
                                 -cos(b) * sin(a),
                                 -0.4,
                                 0,
                                 sin(a),
                                 cos(a),
                                 -199.5,
                                 0,
                                 0,
                                 0,
                                 1};
        view.source[0] = view.source[1] = 0;
        view.source[2] = -200;
        check_cancels("rod", &view, &rod, pose, 1);
        check_cancels("few faces", &view, &coarse, pose, 1);
    }
    shape_free(&rod);
    shape_free(&coarse);
}
END_TEST

/* --- truth ----------------------------------------------------------------------------------------------- */

typedef struct {
    double rms, worst, longest;
} errors;

static errors compare(const skg_view *view, const picture *result, const double *truth) {
    errors e = {0};
    const int64_t count = view->rows * view->columns;
    for (int64_t p = 0; p < count; p++) {
        const double d = result->values[p] - truth[p];
        e.rms += d * d / (double)count;
        e.worst = fmax(e.worst, fabs(d));
        e.longest = fmax(e.longest, truth[p]);
    }
    e.rms = sqrt(e.rms);
    return e;
}

START_TEST(lengths_are_those_of_the_referee) {
    shape sphere = shape_sphere(40, 24, 12), box = shape_box(30, 20, 10);
    body bodies[THREE];
    three_bodies(&sphere, &box, bodies);
    for (int n = 0; n < 6; n++) {
        skg_view view = view_make(48, 40, 2.7);
        view.projection = n % 3;
        if (n % 3 == SKG_PROJECTION_PARALLEL_FROM_INFINITY) view.source[0] = 0.1, view.source[2] = 1;
        if (n % 3 == SKG_PROJECTION_PARALLEL) view.source[0] = 30;
        if (n >= 3 && n % 3 != SKG_PROJECTION_PARALLEL_FROM_INFINITY)
            view.source[2] = 6;                        /* within the bodies */
        view.centre[2] = n == 4 ? 20 : 200;            /* and the detector, too */
        view.row_step[2] = n == 1 || n == 4 ? 0.4 : 0; /* tilted */
        double *truth = referee(&view, THREE, bodies);
        for (int32_t precision = SKG_PRECISION_SINGLE; precision <= SKG_PRECISION_DOUBLE; precision++) {
            if (precision == SKG_PRECISION_DOUBLE && !context->device->info.double_precision) continue;
            skg_raster_options options = options_of(precision, SKG_STRATEGY_COPIES);
            options.kernels.parallel = n % 3 != SKG_PROJECTION_POINT;
            options.kernels.source_plane = n >= 3;
            picture result;
            const double scale =
                scale_of(&options) / (n % 3 == SKG_PROJECTION_PARALLEL_FROM_INFINITY ? 256 : 1); /* mm */
            ck_skg(picture_take(context, &options, &view, THREE, bodies, scale, &result));
            const errors e = compare(&view, &result, truth);
            /* Single: the bars of docs/numerics.md#precision. Double: a hundred times its epsilon, and the scale's own
             * step. */
            ck_assert_double_le(e.rms, (precision == SKG_PRECISION_SINGLE ? 3e-7 : 1e-11) * e.longest);
            ck_assert_double_le(e.worst, (precision == SKG_PRECISION_SINGLE ? 3e-5 : 1e-11) * e.longest);
            picture_free(&result);
        }
        free(truth);
    }
    shape_free(&sphere);
    shape_free(&box);
}
END_TEST

START_TEST(plates_in_series_add_up) {
    enum { PLATES = 100 };
    shape plate = shape_box(400, 400, 1);
    body plates[PLATES];
    for (int k = 0; k < PLATES; k++) {
        plates[k] = body_make(&plate, 0);
        plates[k].pose[11] = -700 + 8 * k;
    }
    skg_view view = view_make(32, 32, 1);
    skg_raster_options options = options_of(SKG_PRECISION_SINGLE, SKG_STRATEGY_COPIES);
    picture result;
    ck_skg(picture_take(context, &options, &view, PLATES, plates, 0x1p32, &result));
    for (int64_t p = 0; p < 32 * 32; p++) {
        const double x = (double)(p % 32) - 15.5, y = (double)(p / 32) - 15.5;
        /* 200 hits, each rounded to half a step of 1200 / 2^32 mm and to a few units of 1 mm's last place. */
        ck_assert_double_eq_tol(result.values[p], 100 * sqrt(1 + (x * x + y * y) / (1200 * 1200)), 2e-4);
    }
    picture_free(&result);
    shape_free(&plate);
}
END_TEST

/* --- what is wrong is reported ------------------------------------------------------------------------------- */

START_TEST(vertex_that_is_not_finite) {
    shape sphere = shape_sphere(40, 24, 12), bad = shape_sphere(40, 24, 12);
    bad.positions[3 * 17 + 1] = (double)NAN;
    bad.positions[3 * 30] = (double)INFINITY;
    body bodies[2] = {body_make(&sphere, 0), body_make(&bad, 0)};
    skg_view view = view_make(64, 64, 2);
    skg_raster_options options = options_of(SKG_PRECISION_SINGLE, SKG_STRATEGY_COPIES);
    picture result;
    ck_skg(picture_take(context, &options, &view, 2, bodies, 0x1p28, &result));
    ck_assert_int_eq(result.bad, sphere.vertices + 17);
    picture_free(&result);
    int32_t merged[30] = {0, 1, 3};
    skg_mesh_layout layouts[2] = {{.vertices = 10}, {.vertices = 30, .source = merged}};
    skg_geometry geometry = {.parts = 3,
                             .vertices = 40,
                             .first_vertex = (int64_t[]){0, 10, 10, 40},
                             .mesh_of_part = (int64_t[]){0, 0, 1},
                             .layouts = layouts};
    int64_t part = 0, vertex = 0;
    skg_geometry_find(&geometry, 12, &part, &vertex); /* vertex 2 of the device is the mesh's 3 */
    ck_assert_int_eq(part, 2);
    ck_assert_int_eq(vertex, 3);
    skg_geometry_find(&geometry, 7, &part, &vertex);
    ck_assert_int_eq(part, 0);
    ck_assert_int_eq(vertex, 7);
    shape_free(&sphere);
    shape_free(&bad);
}
END_TEST

START_TEST(pixels_of_an_open_mesh) {
    shape open = shape_sphere(40, 24, 12);
    open.triangles -= 80;
    body b = body_make(&open, 0);
    b.weight = 0;
    b.bias = 1;
    skg_view view = view_make(64, 64, 2);
    skg_raster_options options = options_of(SKG_PRECISION_SINGLE, SKG_STRATEGY_COPIES);
    options.kernels.listed = 1;
    picture result;
    ck_skg(picture_take(context, &options, &view, 1, &b, 0x1p28, &result));
    int expected[1 + SKG_FIRST_BAD] = {0};
    for (int p = 0; p < 64 * 64; p++)
        if (result.sums[p] != 0 && ++expected[0] <= SKG_FIRST_BAD) expected[expected[0]] = p;
    ck_assert_int_gt(expected[0], SKG_FIRST_BAD);
    ck_assert_mem_eq(result.bad_pixels, expected, sizeof expected);
    picture_free(&result);
    shape_free(&open);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, strategies_give_the_same_bits);
    tcase_add_test(tests, planes_are_apart);
    tcase_add_test(tests, order_and_threads_do_not_matter);
    tcase_add_test(tests, corners_within_three_ulps_of_rays);
    tcase_add_test(tests, edges_on_pixel_centres);
    tcase_add_test(tests, slivers_and_dust);
    tcase_add_test(tests, source_inside);
    tcase_add_test(tests, turned_rods_round_the_source);
    tcase_add_test(tests, lengths_are_those_of_the_referee);
    tcase_add_test(tests, plates_in_series_add_up);
    tcase_add_test(tests, vertex_that_is_not_finite);
    tcase_add_test(tests, pixels_of_an_open_mesh);
}

SKG_SUITE_MAIN("raster", add_tests)
