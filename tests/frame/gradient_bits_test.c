/* Independence of gradients from strategy and order, and scenes without a gradient. */
#include "gradients.h"

#include <math.h>
#include <string.h>

/* A setting's gradient with a precision and a strategy. Everything is released but `r`, whose vertices are those of the body. */
static void gradient_of(const setting *set, int32_t precision, int32_t strategy, result *r,
                        double *vertices) {
    static double adjoint[CHANNELS_MAX * PIXELS];
    int64_t count, triangles;
    make_scene(set);
    allocate(r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, precision, strategy);
    fill_adjoint(CHANNELS_MAX * PIXELS, adjoint);
    make_gradient(plan, set, adjoint, r);
    ck_skg(skg_mesh_count(meshes[0], &count, &triangles));
    memcpy(vertices, r->vertices[0], 3 * (size_t)count * sizeof *vertices);
    skg_plan_release(&plan);
    release(r);
}

enum { VERTICES_MAX = 400 };

static const setting rich = {
    .name = "rich", .priority = 1, .colours = 1, .quantity = SKG_QUANTITY_TRANSMISSION};

/* Sums over hits are integers, whoever has added up the image. */
START_TEST(strategies_give_the_same_bits) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    const int32_t precision = _i ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    static double vertices[3][3 * VERTICES_MAX];
    result r[3];
    if (_i && !run_has_double()) return;
    for (int s = 0; s < 3; s++) gradient_of(&rich, precision, strategies[s], &r[s], vertices[s]);
    for (int s = 1; s < 3; s++) {
        ck_assert_mem_eq(r[s].poses, r[0].poses, sizeof r[s].poses);
        ck_assert_mem_eq(r[s].source, r[0].source, sizeof r[s].source);
        ck_assert_mem_eq(r[s].detector, r[0].detector, sizeof r[s].detector);
        ck_assert_mem_eq(vertices[s], vertices[0], sizeof vertices[s]);
    }
}
END_TEST

static double size_of(const double *numbers, int count) {
    double square = 0;
    for (int k = 0; k < count; k++) square += numbers[k] * numbers[k];
    return sqrt(square);
}

static double difference_of(const double *a, const double *b, int count) {
    double square = 0;
    for (int k = 0; k < count; k++) square += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(square);
}

/* Single precision: hits that rounding moves across an edge belong to another face, so that single pixels may differ; the sums
 * over an image agree. */
START_TEST(single_precision_agrees_with_double) {
    static double vertices[2][3 * VERTICES_MAX];
    result r[2];
    if (!run_has_double()) return;
    for (int s = 0; s < 2; s++)
        gradient_of(&rich, s ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO, &r[s],
                    vertices[s]);
    /* Corners are known to 6e-8 of some tens of pixels, a length's slope to as much of the size of a face of a few pixels. */
    const double change = 2e-5;
    for (int p = 0; p < 3; p++) {
        ck_assert_double_le(difference_of(r[0].poses[p], r[1].poses[p], 3),
                            change * size_of(r[1].poses[p], 3));
        ck_assert_double_le(difference_of(r[0].poses[p] + 3, r[1].poses[p] + 3, 3),
                            change * size_of(r[1].poses[p] + 3, 3));
    }
    ck_assert_double_le(difference_of(r[0].source, r[1].source, 3), change * size_of(r[1].source, 3));
    ck_assert_double_le(difference_of(r[0].detector, r[1].detector, 3), change * size_of(r[1].detector, 3));
    ck_assert_double_le(difference_of(r[0].detector + 3, r[1].detector + 3, 3),
                        change * size_of(r[1].detector + 3, 3));
    ck_assert_double_le(difference_of(vertices[0], vertices[1], 3 * VERTICES_MAX),
                        change * size_of(vertices[1], 3 * VERTICES_MAX));
}
END_TEST

/* A lane of a processor's vector adds up many hits of a wide face before they become integers: rounding grows with their number, and has
 * to stay below that of the places of corners. */
START_TEST(wide_faces_agree_with_double) {
    enum { COLUMNS = 1024, ROWS = 12, COUNT = COLUMNS * ROWS };
    static const double tilted[16] = {0.96, 0.1, 0.26, 3, -0.1, 0.995, 0, 2, -0.26, 0, 0.96, 5, 0, 0, 0, 1};
    static double adjoint[COUNT];
    double poses[2][6], source[2][3], detector[2][6];
    if (!run_has_double()) return;
    for (int i = 0; i < COUNT; i++) adjoint[i] = 1 + 0.5 * sin(i);
    solid slab = solid_box(1400, 60, 7);
    scene = run_scene(&slab, tilted);
    skg_view view = run_view(COLUMNS, 1);
    view.rows = ROWS;
    skg_adjoint given = adjoint_of(adjoint);
    given.rows = ROWS, given.columns = COLUMNS;
    for (int d = 0; d < 2; d++) {
        skg_gradient gradient;
        skg_plan *plan = run_plan(scene, &view,
                                  (run_choice){.precision = d ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                                               .quantity = SKG_QUANTITY_ATTENUATION});
        skg_gradient_init(&gradient);
        gradient.poses = poses[d], gradient.source = source[d], gradient.detector = detector[d];
        ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
        skg_plan_release(&plan);
    }
    /* As above: corners are known to 6e-8 of the face's size, and the slab's two sides nearly cancel in its translations. */
    const double change = 2e-5;
    ck_assert_double_le(difference_of(poses[0], poses[1], 3), change * size_of(poses[1], 3));
    ck_assert_double_le(difference_of(poses[0] + 3, poses[1] + 3, 3), change * size_of(poses[1] + 3, 3));
    ck_assert_double_le(difference_of(source[0], source[1], 3), change * size_of(source[1], 3));
    ck_assert_double_le(difference_of(detector[0], detector[1], 3), change * size_of(detector[1], 3));
    skg_scene_release(&scene);
    solid_free(&slab);
}
END_TEST

/* Noise is constant: the gradient is that of the mean. */
START_TEST(noise_is_constant) {
    static double vertices[2][3 * VERTICES_MAX];
    setting noisy = rich;
    result r[2];
    noisy.noise = 1;
    gradient_of(&rich, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO, &r[0], vertices[0]);
    gradient_of(&noisy, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO, &r[1], vertices[1]);
    for (int p = 0; p < 3; p++) /* Weights of ratios and of photons are rounded to float in another order. */
        ck_assert_double_le(difference_of(r[0].poses[p], r[1].poses[p], 6),
                            64 * 0x1p-23 * size_of(r[0].poses[p], 6));
}
END_TEST

/* All parts, source and detector together move nothing; so does turning all of them. */
START_TEST(a_whole_that_moves_changes_nothing) {
    static double vertices[3 * VERTICES_MAX];
    result r;
    if (!run_has_double()) return;
    const setting set = {
        .colours = 1, .priority = _i == 1, .falloff = _i == 2, .supersampling = 2, .spot = _i == 2};
    gradient_of(&set, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO, &r, vertices);
    const skg_view view = make_view(&set);
    double size = size_of(&r.poses[0][0], 6);
    for (int k = 0; k < 6; k++) {
        const double *s = view.source, *g = r.source;
        double sum = r.detector[k] +
                     (k < 3 ? g[k] : s[(k + 1) % 3] * g[(k + 2) % 3] - s[(k + 2) % 3] * g[(k + 1) % 3]);
        for (int p = 0; p < parts; p++) sum += r.poses[p][k];
        /* Moments are integers of at least 32 bits below the largest hit. A turn has the source's lever of 1000 mm. */
        ck_assert_double_le(fabs(sum), 1e-8 * size * (k < 3 ? 1 : 1000));
    }
}
END_TEST

/* --- sums that stand */

/* Changes between an image and the gradient of the plan's scene. */
enum { NOTHING, A_POSE, VERTICES, LENGTHS, A_VIEW, DENSITIES, CHANGES };

static void submit_and_wait(skg_plan *plan, const skg_frame *frame, const skg_output *output) {
    skg_job *job = NULL;
    ck_skg(skg_plan_submit(plan, 1, frame, 1, output, &job));
    ck_skg(skg_job_wait(&job));
}

static void change(int what, skg_plan *plan, const skg_view *view) {
    static float image[PIXELS];
    const int64_t body = 0;
    const double ratio = 0.5;
    skg_view other = *view;
    skg_frame frame;
    skg_output output;
    skg_part part;
    double *positions = NULL;
    int64_t count, triangles;
    skg_frame_init(&frame);
    skg_output_init(&output);
    skg_part_init(&part);
    output.data = image;
    switch (what) {
    case A_POSE:
        ck_skg(skg_scene_part_get(scene, 0, &part));
        part.pose[3] += 1;
        ck_skg(skg_scene_part_pose_set(scene, 0, part.pose));
        return;
    case VERTICES:
        ck_skg(skg_mesh_count(meshes[1], &count, &triangles));
        positions = calloc((size_t)(3 * count), sizeof *positions);
        ck_skg(skg_mesh_positions_get(meshes[1], positions, 3));
        for (int64_t k = 0; k < 3 * count; k++) positions[k] *= 1.01;
        ck_skg(skg_mesh_positions_set(meshes[1], positions, 3));
        free(positions);
        return;
    case LENGTHS:
        output.kind = SKG_OUTPUT_LENGTHS, output.lengths = SKG_LENGTHS_NET;
        submit_and_wait(plan, NULL, &output);
        return;
    case A_VIEW:
        other.source[0] += 5;
        frame.view = &other;
        submit_and_wait(plan, &frame, &output);
        return;
    case DENSITIES:
        frame.override_count = 1, frame.override_parts = &body, frame.density_ratios = &ratio;
        submit_and_wait(plan, &frame, &output);
        return;
    default:
        return;
    }
}

/* A gradient of the frame that was rendered last uses its sums; of any other it makes them. */
START_TEST(sums_that_stand_are_those_of_the_frame) {
    static double adjoint[CHANNELS_MAX * PIXELS];
    static float image[PIXELS];
    const setting set = {.nested = _i % 2, .priority = 1 - _i % 2, .colours = 1};
    skg_output output;
    result r[2];
    make_scene(&set);
    allocate(&r[0]);
    r[1] = r[0];
    skg_output_init(&output);
    output.data = image;
    const skg_view view = make_view(&set);
    fill_adjoint(PIXELS, adjoint);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    for (int turn = 0; turn < 2; turn++) {
        submit_and_wait(plan, NULL, &output);
        change(_i / 2, plan, &view);
        make_gradient(plan, &set, adjoint, &r[0]);
        skg_plan *fresh = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
        make_gradient(fresh, &set, adjoint, &r[1]);
        skg_plan_release(&fresh);
        ck_assert_mem_eq(r[0].poses, r[1].poses, sizeof r[0].poses);
        ck_assert_mem_eq(r[0].source, r[1].source, sizeof r[0].source);
        ck_assert_mem_eq(r[0].densities, r[1].densities, sizeof r[0].densities);
    }
    skg_plan_release(&plan);
    release(&r[0]);
}
END_TEST

/* --- what is refused */

START_TEST(bad_adjoints_are_refused) {
    static double values[PIXELS];
    const setting set = {.colours = 1};
    result r;
    skg_gradient gradient;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    skg_gradient_init(&gradient);
    gradient.source = r.source;
    skg_adjoint adjoint = adjoint_of(values);
    ck_skg_fails(skg_plan_gradient(NULL, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "plan");
    ck_skg_fails(skg_plan_gradient(plan, NULL, NULL, &gradient), SKG_ERR_ARGUMENT, "adjoint");
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, NULL), SKG_ERR_ARGUMENT, "gradient");
    adjoint.rows = SIDE + 1;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "25 x 24");
    adjoint = adjoint_of(values);
    adjoint.channels = 2;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "2 channels");
    adjoint = adjoint_of(NULL);
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "NULL");
    adjoint = adjoint_of(values);
    adjoint.type = SKG_TYPE_UINT16;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "type 2");
    adjoint = adjoint_of(values);
    values[SIDE + 3] = (double)NAN;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "row 1, column 3");
    values[SIDE + 3] = 0;
    ck_skg(skg_plan_gradient(plan, NULL, &adjoint, &gradient));
    for (int k = 0; k < 3; k++) ck_assert_double_eq(r.source[k], 0);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* Makes a plan with options that have no gradient, and tries. */
static void try_options(const skg_plan_options *options, const skg_view *view, const char *text) {
    static const double energies[2] = {40, 80}, photons[2] = {50, 80};
    static const double values[PIXELS];
    double source[3];
    skg_gradient gradient;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_gradient_init(&gradient);
    gradient.source = source;
    const skg_adjoint adjoint = adjoint_of(values);
    ck_skg(skg_spectrum_create_bins(2, energies, photons, &beam));
    ck_skg(skg_plan_create(run_context, scene, view, beam, options, &plan));
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_UNSUPPORTED, text);
    skg_spectrum_release(&beam);
    skg_plan_release(&plan);
}

START_TEST(what_has_no_gradient_is_refused_by_name) {
    const setting set = {.colours = 1};
    skg_plan_options options;
    skg_heel heel;
    skg_grid grid;
    skg_scatter scatter;
    skg_collimation jaws;
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_view near = view;
    skg_heel_init(&heel);
    skg_grid_init(&grid);
    skg_scatter_init(&scatter);
    skg_collimation_init(&jaws);
    heel.kvp = 100, heel.direction[1] = 1;
    grid.ratio = 8, grid.lines_per_cm = 40, grid.strip_mm = 0.05;
    jaws.kind = SKG_COLLIMATION_DETECTOR, jaws.margin_mm = -20;
    scatter.histories = 32;
    skg_plan_options_init(&options);
    options.precision = SKG_PRECISION_HALF;
    try_options(&options, &view, "precision half");
    skg_plan_options_init(&options);
    options.heel = &heel;
    try_options(&options, &view, "heel");
    skg_plan_options_init(&options);
    options.grid = &grid;
    try_options(&options, &view, "grid");
    skg_plan_options_init(&options);
    options.collimation = &jaws;
    try_options(&options, &view, "collimator");
    skg_plan_options_init(&options);
    options.scatter = &scatter;
    try_options(&options, &view, "scatter");
    skg_plan_options_init(&options);
    options.noise = 1, options.falloff = 1, options.quantity = SKG_QUANTITY_TRANSMISSION;
    try_options(&options, &view, "flat field");
    skg_plan_options_init(&options);
    near.source[0] = near.source[1] = 0, near.source[2] = 0;
    try_options(&options, &near, "part body reaches the plane of the source");
    release(&r);
}
END_TEST

START_TEST(leaky_meshes_are_refused_by_name) {
    static const double values[PIXELS];
    double poses[6];
    skg_gradient gradient;
    skg_gradient_init(&gradient);
    gradient.poses = poses;
    solid box = solid_box(20, 20, 20);
    box.triangles--;
    const skg_adjoint adjoint = adjoint_of(values);
    const skg_view view = run_view(SIDE, 4);
    scene = run_scene(&box, NULL);
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_UNSUPPORTED,
                 "the mesh of part solid is not closed");
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, strategies_give_the_same_bits, 0, 2);
    tcase_add_test(tests, single_precision_agrees_with_double);
    tcase_add_test(tests, wide_faces_agree_with_double);
    tcase_add_test(tests, noise_is_constant);
    tcase_add_loop_test(tests, a_whole_that_moves_changes_nothing, 0, 3);
    tcase_add_loop_test(tests, sums_that_stand_are_those_of_the_frame, 0, 2 * CHANGES);
    tcase_add_test(tests, bad_adjoints_are_refused);
    tcase_add_test(tests, what_has_no_gradient_is_refused_by_name);
    tcase_add_test(tests, leaky_meshes_are_refused_by_name);
}

SKG_SUITE_MAIN("gradient_bits", add_tests)
