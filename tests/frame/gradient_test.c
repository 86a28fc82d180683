/* Gradients against differences of images in double precision, with Richardson's step: (4 D(h/2) - D(h)) / 3. Pixels whose
 * hits change within the step are left out: their differences at two steps disagree. */
#include "gradients.h"
#include "support/doubles.h"

#include <math.h>

static const setting settings[] = {
    {.name = "one energy"},
    {.name = "attenuation of one energy", .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "a hole by priority", .priority = 1, .hole = 1, .world = 1, .colours = 1},
    {.name = "parallel from infinity", .parallel = 1, .infinity = 1, .colours = 1},
    {.name = "parallel, priority", .parallel = 1, .priority = 1},
    {.name = "world, attenuation",
     .world = 1,
     .colours = 1,
     .quantity = SKG_QUANTITY_ATTENUATION,
     .parts_only = 1},
    {.name = "spot, supersampling, falloff", .spot = 1, .supersampling = 2, .falloff = 1, .priority = 1},
    {.name = "blur", .blur = 1, .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "point spread", .blur = 2, .nested = 1},
    {.name = "bands", .bands = 2, .colours = 1, .nested = 1},
    {.name = "tolerance 1e-4", .tolerance = 1e-4, .colours = 1, .priority = 1},
    {.name = "nested to depth 4", .nested = 2, .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "heel", .heel = 1, .colours = 1, .parts_only = 1},
    /* Each of these lies in one of those above, or in several: for ./check --full. */
    {.name = "transmission", .quantity = SKG_QUANTITY_TRANSMISSION, .colours = 1},
    {.name = "attenuation", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .nested = 1},
    {.name = "nested", .nested = 1, .colours = 1},
    {.name = "priority", .priority = 1, .colours = 1},
    {.name = "parallel", .parallel = 1, .nested = 1},
    {.name = "world", .world = 1, .colours = 1},
    {.name = "falloff", .falloff = 1, .colours = 1, .quantity = SKG_QUANTITY_FLUENCE},
    {.name = "supersampling", .supersampling = 3, .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1},
    {.name = "spot", .spot = 1, .quantity = SKG_QUANTITY_TRANSMISSION},
    {.name = "tolerance", .tolerance = 1e-3, .colours = 1, .nested = 1},
};

/* Direction number `way`: a twist of a part, the source, the detector, or the vertices of a part. */
static int make_direction(const setting *set, int way, direction *d) {
    const double mm = set->infinity ? 1e-3 : 1, radian = 1e-2;
    *d = (direction){.source = {0}};
    if (way < 6 * PARTS)
        d->poses[way / 6][way % 6] = way % 6 < 3 ? 1 : radian;
    else if (way < 6 * PARTS + 3)
        d->source[way - 6 * PARTS] = mm;
    else if (way < 6 * PARTS + 9)
        d->detector[way - 6 * PARTS - 3] = way < 6 * PARTS + 6 ? 1 : radian;
    else if (way < 7 * PARTS + 9)
        d->vertices[way - 6 * PARTS - 9] = 1;
    else
        d->densities[way - 7 * PARTS - 9] = 1;
    const int64_t part = way < 6 * PARTS ? way / 6 : way < 6 * PARTS + 9 ? 0 : (way - 6 * PARTS - 9) % PARTS;
    const int of_view = way >= 6 * PARTS && way < 6 * PARTS + 9;
    return part < parts && !(of_view && set->parts_only);
}

/* The derivative along a direction against differences, pixel by pixel. */
static void compare_pixels(const setting *set, skg_plan *plan, int way, const direction *d, int64_t count,
                           const double *slope) {
    static double derivative[CHANNELS_MAX * PIXELS];
    const double bar = way < 7 * PARTS + 9 ? 1e-5 : 1e-6; /* images are smooth in densities */
    double largest = 0;
    make_derivative(plan, d, derivative);
    for (int64_t p = 0; p < count; p++) largest = isnan(slope[p]) ? largest : fmax(largest, fabs(slope[p]));
    for (int64_t p = 0; p < count; p++)
        /* As for the sums; a hit may change slightly and pass the test of differences */
        ck_assert_msg(isnan(slope[p]) || fabs(derivative[p] - slope[p]) <= bar * largest,
                      "%s, direction %d, pixel %d: %.12g, by differences %.12g of %.3g", set->name, way,
                      (int)p, derivative[p], slope[p], largest);
}

START_TEST(gradients_are_those_of_differences) {
    const setting *set = &settings[_i];
    static double slope[CHANNELS_MAX * PIXELS], adjoint[CHANNELS_MAX * PIXELS];
    const int64_t count = (set->bands ? set->bands : 1) * PIXELS;
    result r;
    direction d;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    for (int way = 0; way < WAYS; way++) {
        uint64_t state = 1 + (uint64_t)way;
        double expected = 0, size = 0;
        int64_t used = 0;
        if (!make_direction(set, way, &d)) continue;
        differentiate(plan, &view, &d, count, slope);
        for (int64_t p = 0; p < count; p++) {
            adjoint[p] = isnan(slope[p]) ? 0 : draw(&state, -0.5, 0.5);
            if (isnan(slope[p])) continue;
            expected += adjoint[p] * slope[p];
            size += fabs(adjoint[p] * slope[p]);
            used += slope[p] != 0;
        }
        compare_pixels(set, plan, way, &d, count, slope);
        make_gradient(plan, set, adjoint, &r);
        const double got = along(&r, &d);
        /* Rounding of two images by the step: 1e-12 / 1e-3, over thousands of pixels */
        ck_assert_msg(fabs(got - expected) <= 1e-6 * size,
                      "%s, direction %d: %.12g, by differences %.12g of %.3g", set->name, way, got, expected,
                      size);
        ck_assert_int_gt(used, set->nested > 1 ? 1 : 5); /* the core covers few pixels */
    }
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* --- silhouettes and faces that contain rays */

/* Path lengths are continuous across silhouettes, so that a pixel's value changes by the integral of its derivative, which is not
 * bounded there. */
START_TEST(values_change_by_the_integral_of_the_gradient) {
    enum { STEPS = 4000 };
    const setting set = {.colours = 1, .quantity = SKG_QUANTITY_ATTENUATION};
    static double first[PIXELS], last[PIXELS], adjoint[PIXELS];
    const double pitch = 4.1 * 1000 / 1200; /* about a pixel, where the body is */
    double integral = 0, change = 0, size = 0;
    result r;
    if (!run_has_double()) return;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    const direction d = {.poses = {{pitch}}};
    fill_adjoint(PIXELS, adjoint);
    render(plan, &view, &d, 0, first);
    render(plan, &view, &d, 1, last);
    for (int p = 0; p < PIXELS; p++)
        change += adjoint[p] * (last[p] - first[p]), size += fabs(adjoint[p] * (last[p] - first[p]));
    for (int s = 0; s < STEPS; s++) {
        skg_gradient gradient;
        skg_frame frame;
        skg_part part;
        const int64_t body = 0;
        const skg_adjoint given = adjoint_of(adjoint);
        skg_part_init(&part);
        skg_frame_init(&frame);
        skg_gradient_init(&gradient);
        ck_skg(skg_scene_part_get(scene, 0, &part));
        part.pose[3] += pitch * (s + 0.5) / STEPS;
        frame.pose_count = 1, frame.pose_parts = &body, frame.poses = part.pose;
        gradient.poses = r.poses[0];
        ck_skg(skg_plan_gradient(plan, &frame, &given, &gradient));
        integral += r.poses[0][0] * pitch / STEPS;
    }
    /* 4000 steps over slopes like the inverse root of a distance: their sum errs by the root of 1/4000 of the few that are large. */
    ck_assert_msg(fabs(integral - change) <= 1e-3 * size, "%.10g, integral %.10g of %.3g", change, integral,
                  size);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* The sides of a box in a parallel beam contain rays. The mean of the pixels changes by depth times edge, exactly. */
START_TEST(sides_of_a_box_change_the_mean) {
    static double adjoint[PIXELS];
    const double x = 21.3, y = 17.9, z = 33, pitch = 4;
    double poses[6], vertices[24];
    double *const of_parts[1] = {vertices};
    skg_gradient gradient;
    solid box = solid_box(x, y, z);
    skg_view view = run_view(SIDE, pitch);
    view.projection = SKG_PROJECTION_PARALLEL;
    scene = run_scene(&box, NULL);
    skg_plan *plan = run_plan(
        scene, &view,
        (run_choice){.precision = _i && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                     .quantity = SKG_QUANTITY_ATTENUATION});
    skg_gradient_init(&gradient);
    gradient.poses = poses, gradient.vertices = of_parts;
    /* mu is 0.1 per mm; the loss is the sum of the pixels right of the middle, that is 0.1 z y / pitch^2 for each mm */
    for (int p = 0; p < PIXELS; p++) adjoint[p] = p % SIDE >= SIDE / 2;
    const skg_adjoint given = adjoint_of(adjoint);
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    const double expected = 0.1 * z * y / (pitch * pitch);
    ck_assert_double_eq_tol(poses[0], expected, 1e-5 * expected); /* mu of the material in single precision */
    ck_assert_double_eq_tol(poses[1], 0, 1e-5 * expected);        /* the same */
    double right = 0;
    for (int v = 0; v < 8; v++) right += box.positions[3 * v] > 0 ? vertices[3 * v] : 0;
    ck_assert_double_eq_tol(right, expected, 1e-5 * expected); /* the same */
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

/* Along a direction the same sides change the pixels that see them: those of the right side gain depth over pitch for a mm, those of
 * the left side lose it, by their share of its height. */
START_TEST(sides_of_a_box_change_pixels_along_a_direction) {
    static double found[PIXELS];
    const double x = 21.3, y = 17.9, z = 33, pitch = 4;
    double twist[6] = {1};
    skg_direction moving;
    int64_t saturated = -1;
    solid box = solid_box(x, y, z);
    skg_view view = run_view(SIDE, pitch);
    view.projection = SKG_PROJECTION_PARALLEL;
    scene = run_scene(&box, NULL);
    skg_plan *plan = run_plan(
        scene, &view,
        (run_choice){.precision = _i && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                     .quantity = SKG_QUANTITY_ATTENUATION});
    skg_direction_init(&moving);
    moving.poses = twist;
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &moving, DOUBLES(found), &saturated));
    ck_assert_int_eq(saturated, 0);
    for (int p = 0; p < PIXELS; p++) {
        const double left = (p % SIDE - SIDE / 2) * pitch, low = (p / SIDE - SIDE / 2) * pitch;
        const double high = fmin(low + pitch, y / 2), share = fmax(high - fmax(low, -y / 2), 0) / pitch;
        const int sign = (x / 2 > left && x / 2 < left + pitch) - (-x / 2 > left && -x / 2 < left + pitch);
        /* mu is 0.1 per mm, in single precision */
        ck_assert_double_eq_tol(found[p], sign * share * 0.1 * z / pitch, 1e-5 * 0.1 * z / pitch);
    }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

/* The sides of a box that the source stands in the plane of, and any direction: the sum over pixels of weights times the derivative is
 * the gradient of the weights, along that direction. */
START_TEST(a_derivative_of_sides_is_along_the_gradient) {
    static double adjoint[PIXELS], found[PIXELS];
    const double x = 21.3, y = 17.9, pitch = 4;
    double twist[6] = {0.3, -0.8, 0.4, 0.01, -0.02, 0.03}, moves[24], source[3] = {0.5, 1.1, -0.7};
    double detector[6] = {-0.2, 0.6, 0.9, 0.02, 0.01, -0.03};
    double poses[6], vertices[24], of_source[3], of_detector[6], sum = 0, size = 0, expected = 0;
    double *const of_parts[1] = {vertices};
    const double *const moves_of_parts[1] = {moves};
    skg_direction moving;
    skg_gradient gradient;
    solid box = solid_box(x, y, 33);
    skg_view view = run_view(SIDE, pitch);
    if (_i & 1)
        view.projection = SKG_PROJECTION_PARALLEL;
    else
        view.source[0] = x / 2, view.source[1] = -y / 2;
    scene = run_scene(&box, NULL);
    skg_plan *plan = run_plan(
        scene, &view,
        (run_choice){.precision = _i & 2 && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                     .quantity = SKG_QUANTITY_ATTENUATION});
    skg_direction_init(&moving);
    skg_gradient_init(&gradient);
    fill_adjoint(PIXELS, adjoint);
    const skg_adjoint given = adjoint_of(adjoint);
    for (int k = 0; k < 24; k++) moves[k] = sin(k);
    moving.poses = twist, moving.source = source, moving.detector = detector;
    moving.vertices = moves_of_parts;
    gradient.poses = poses, gradient.source = of_source, gradient.detector = of_detector;
    gradient.vertices = of_parts;
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &moving, DOUBLES(found), NULL));
    for (int k = 0; k < 6; k++) expected += twist[k] * poses[k] + detector[k] * of_detector[k];
    for (int k = 0; k < 3; k++) expected += source[k] * of_source[k];
    for (int k = 0; k < 24; k++) expected += moves[k] * vertices[k];
    for (int p = 0; p < PIXELS; p++) sum += adjoint[p] * found[p], size += fabs(adjoint[p] * found[p]);
    ck_assert_double_gt(size, 1);
    /* Weights and slopes in the precision of the plan; a few faces are lines to the one and not to the other */
    ck_assert_double_eq_tol(sum, expected, (_i & 2 && run_has_double() ? 1e-9 : 1e-5) * size);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, gradients_are_those_of_differences, 0,
                        suite_turns(sizeof settings / sizeof *settings, 13));
    tcase_add_test(tests, values_change_by_the_integral_of_the_gradient);
    tcase_add_loop_test(tests, sides_of_a_box_change_the_mean, 0, 2);
    tcase_add_loop_test(tests, sides_of_a_box_change_pixels_along_a_direction, 0, 2);
    tcase_add_loop_test(tests, a_derivative_of_sides_is_along_the_gradient, 0, 4);
}

SKG_SUITE_MAIN("gradient", add_tests)
