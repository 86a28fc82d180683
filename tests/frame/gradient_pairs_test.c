/* Gradients with effects in pairs, of a thousand parts, and on any number of threads. Everything moves at once; the derivative
 * along this direction is compared with differences of images, and reverse with forward. */
#define _GNU_SOURCE
#include "gradients.h"

#include <math.h>
#include <sched.h>
#include <string.h>

static const setting effects[] = {
    {.name = "nested", .nested = 1},
    {.name = "priority", .priority = 1},
    {.name = "parallel", .parallel = 1},
    {.name = "falloff", .falloff = 1},
    {.name = "supersampling", .supersampling = 2},
    {.name = "spot", .spot = 1},
    {.name = "blur", .blur = 1},
    {.name = "bands", .bands = 2},
    {.name = "tolerance", .tolerance = 1e-4},
    {.name = "attenuation", .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "transmission", .quantity = SKG_QUANTITY_TRANSMISSION},
};
enum { EFFECTS = sizeof effects / sizeof *effects };

static setting join(const setting *a, const setting *b) {
    setting both = *a;
    both.colours = 1;
    both.nested |= b->nested, both.priority |= b->priority, both.parallel |= b->parallel;
    both.falloff |= b->falloff, both.supersampling |= b->supersampling, both.spot |= b->spot;
    both.blur |= b->blur, both.bands |= b->bands, both.quantity |= b->quantity;
    both.tolerance = fmax(a->tolerance, b->tolerance);
    return both;
}

/* Attenuation and transmission are two quantities; a parallel beam has no spot and no falloff. */
static int exist_together(const setting *a, const setting *b) {
    const setting both = join(a, b);
    return !(a->quantity && b->quantity) && !(both.parallel && (both.spot || both.falloff));
}

/* A direction in which everything moves. */
static direction move_everything(void) {
    uint64_t state = 77;
    direction d = {.source = {0}};
    for (int64_t p = 0; p < parts; p++) {
        for (int k = 0; k < 6; k++) d.poses[p][k] = (k < 3 ? 1 : 0.01) * draw(&state, -1, 1);
        d.vertices[p] = draw(&state, -0.5, 0.5), d.densities[p] = draw(&state, -0.5, 0.5);
    }
    for (int k = 0; k < 3; k++) d.source[k] = draw(&state, -1, 1);
    for (int k = 0; k < 6; k++) d.detector[k] = (k < 3 ? 1 : 0.01) * draw(&state, -1, 1);
    return d;
}

static void compare_pair(const setting *set, const char *first, const char *second) {
    static double slope[CHANNELS_MAX * PIXELS], adjoint[CHANNELS_MAX * PIXELS],
        derivative[CHANNELS_MAX * PIXELS];
    const int64_t count = (set->bands ? set->bands : 1) * PIXELS;
    double expected = 0, size = 0, forward = 0;
    int64_t used = 0;
    result r;
    make_scene(set);
    allocate(&r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    direction d = move_everything();
    fill_adjoint(count, adjoint);
    differentiate(plan, &view, &d, count, slope);
    for (int64_t p = 0; p < count; p++) {
        if (isnan(slope[p])) adjoint[p] = slope[p] = 0;
        expected += adjoint[p] * slope[p];
        size += fabs(adjoint[p] * slope[p]);
        used += slope[p] != 0;
    }
    make_gradient(plan, set, adjoint, &r);
    /* As in gradient_test: rounding of two images by the step, 1e-12 / 1e-3, over thousands of pixels */
    ck_assert_msg(fabs(along(&r, &d) - expected) <= 1e-6 * size,
                  "%s, %s: %.12g, by differences %.12g of %.3g", first, second, along(&r, &d), expected,
                  size);
    ck_assert_int_gt(used, 50);
    for (int64_t p = 0; p < parts; p++) d.densities[p] = 0; /* are not moved along */
    make_derivative(plan, &d, derivative);
    for (int64_t p = 0; p < count; p++) forward += adjoint[p] * derivative[p];
    /* Integers of at least 32 bits below the largest hit, on both ways */
    ck_assert_msg(fabs(along(&r, &d) - forward) <= 1e-8 * size,
                  "%s, %s: reverse %.12g, forward %.12g of %.3g", first, second, along(&r, &d), forward,
                  size);
    skg_plan_release(&plan);
    release(&r);
}

START_TEST(effects_in_pairs) {
    if (!run_has_double()) return;
    for (int b = _i; b < EFFECTS; b++) {
        if (b != _i && !exist_together(&effects[_i], &effects[b])) continue;
        const setting set = join(&effects[_i], &effects[b]);
        compare_pair(&set, effects[_i].name, effects[b].name);
    }
}
END_TEST

/* A thousand parts of one mesh: all of them, source and detector move nothing together, and a part's derivative is that of
 * differences. */
START_TEST(a_thousand_parts) {
    enum { ACROSS = 10, MANY = ACROSS * ACROSS * ACROSS };
    static double poses[MANY][6], adjoint[PIXELS], images[2][PIXELS];
    double source[3], detector[6], sum[3] = {0}, size = 0, change = 0;
    const double step = 1e-5;
    const int64_t part = 555;
    skg_gradient gradient;
    if (!run_has_double()) return;
    solid ball = solid_blob(3, 9, 7, 3);
    skg_mesh *mesh = run_mesh(&ball);
    const skg_view view = run_view(SIDE, 4.1);
    ck_skg(skg_scene_create(run_context, &scene));
    for (int p = 0; p < MANY; p++) {
        const double at[3] = {7.3 * (p % ACROSS) - 33, 7.1 * (p / ACROSS % ACROSS) - 31.7,
                              7.7 * (p / ACROSS / ACROSS) - 35};
        const double pose[16] = {1, 0, 0, at[0], 0, 1, 0, at[1], 0, 0, 1, at[2], 0, 0, 0, 1};
        char label[16];
        snprintf(label, sizeof label, "ball %d", p);
        run_part(scene, label, mesh, 0.1, pose, -1);
    }
    skg_plan *plan = run_plan(scene, &view, (run_choice){.precision = SKG_PRECISION_DOUBLE});
    fill_adjoint(PIXELS, adjoint);
    const skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&gradient);
    gradient.poses = poses[0], gradient.source = source, gradient.detector = detector;
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int k = 0; k < 3; k++) {
        sum[k] = source[k] + detector[k];
        for (int p = 0; p < MANY; p++) sum[k] += poses[p][k], size += fabs(poses[p][k]);
    }
    /* Integers of at least 32 bits below the largest hit */
    for (int k = 0; k < 3; k++) ck_assert_double_le(fabs(sum[k]), 1e-8 * size);
    for (int s = 0; s < 2; s++) {
        skg_frame frame;
        skg_output output;
        skg_job *job = NULL;
        skg_part moved;
        skg_part_init(&moved);
        skg_frame_init(&frame);
        skg_output_init(&output);
        ck_skg(skg_scene_part_get(scene, part, &moved));
        moved.pose[3] += s ? -step : step;
        frame.pose_count = 1, frame.pose_parts = &part, frame.poses = moved.pose;
        output.type = SKG_TYPE_FLOAT64, output.data = images[s];
        ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
    }
    for (int p = 0; p < PIXELS; p++) change += adjoint[p] * (images[0][p] - images[1][p]) / (2 * step);
    /* Differences err by the square of the step, but for hits at silhouettes: by its root */
    ck_assert_double_eq_tol(poses[part][0], change, 3e-3 * fabs(change));
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_mesh_release(&mesh);
    solid_free(&ball);
}
END_TEST

/* The host adds faces up on all processors that it may use. */
START_TEST(threads_change_no_bit) {
    static double adjoint[CHANNELS_MAX * PIXELS];
    const setting set = {.priority = 1, .colours = 1, .quantity = SKG_QUANTITY_TRANSMISSION};
    cpu_set_t all, one;
    result r[2];
    make_scene(&set);
    allocate(&r[0]);
    r[1] = r[0];
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    fill_adjoint(PIXELS, adjoint);
    make_gradient(plan, &set, adjoint, &r[0]);
    ck_assert_int_eq(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (size_t c = 0; c < CPU_SETSIZE && CPU_COUNT(&one) == 0; c++)
        if (CPU_ISSET(c, &all)) CPU_SET(c, &one);
    ck_assert_int_eq(sched_setaffinity(0, sizeof one, &one), 0);
    make_gradient(plan, &set, adjoint, &r[1]);
    ck_assert_int_eq(sched_setaffinity(0, sizeof all, &all), 0);
    ck_assert_mem_eq(r[0].poses, r[1].poses, sizeof r[0].poses);
    ck_assert_mem_eq(r[0].source, r[1].source, sizeof r[0].source);
    ck_assert_mem_eq(r[0].detector, r[1].detector, sizeof r[0].detector);
    ck_assert_mem_eq(r[0].densities, r[1].densities, sizeof r[0].densities);
    skg_plan_release(&plan);
    release(&r[0]);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, effects_in_pairs, 0, EFFECTS);
    tcase_add_test(tests, a_thousand_parts);
    tcase_add_test(tests, threads_change_no_bit);
}

SKG_SUITE_MAIN("gradient_pairs", add_tests)
