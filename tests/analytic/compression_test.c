/* Images with a tolerance against the same images with every energy and every material's plane. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 48, CHANNELS_MAX = 3 };

typedef struct {
    double pixels[CHANNELS_MAX * SIDE * SIDE];
    skg_plan_report report;
    double open[CHANNELS_MAX];
    int64_t channels;
} picture;

static skg_context *context;
static skg_scene *scene;
static skg_view view;
static uint64_t state;

static double next_random(void) {
    state = state * 6364136223846793005u + 1442695040888963407u; /* Knuth's MMIX */
    return (double)(state >> 11) * 0x1p-53;
}

static void open_scene(uint64_t seed) {
    state = seed;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -800;
    view.centre[2] = 300;
    view.column_step[0] = view.row_step[1] = 6;
}

static void close_scene(void) {
    skg_scene_release(&scene);
    skg_context_release(&context);
}

static void add(skg_mesh *mesh, const char *name, double x, double y, int64_t inside) {
    skg_material *material = NULL;
    skg_part part;
    char label[16];
    int64_t number = 0;
    ck_skg(skg_scene_part_count(scene, &number));
    snprintf(label, sizeof label, "part %d", (int)number);
    ck_skg(skg_material_create_named(name, &material));
    skg_part_init(&part);
    part.mesh = mesh, part.material = material, part.inside = inside, part.label = label;
    part.pose[3] = x, part.pose[7] = y;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&mesh);
    skg_material_release(&material);
}

/* A body, tissues in it, and now and then what has a K edge or lets little pass. */
static void add_parts(int count) {
    static const char *const names[] = {"Adipose Tissue (ICRU-44)",
                                        "Bone, Cortical (ICRU-44)",
                                        "Lung Tissue (ICRU-44)",
                                        "Blood, Whole (ICRU-44)",
                                        "Breast Tissue (ICRU-44)",
                                        "water",
                                        "Brain, Grey/White Matter (ICRU-44)",
                                        "I",
                                        "Fe",
                                        "Gd"};
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cuboid(200, 180, 150 * next_random() + 60, &mesh));
    add(mesh, "Tissue, Soft (ICRU-44)", 0, 0, -1);
    for (int k = 0; k < count; k++) {
        const int which = (int)(10 * next_random());
        const double size = which < 7 ? 20 + 30 * next_random() : 0.3 + next_random();
        if (which < 7)
            ck_skg(skg_mesh_create_sphere(size / 2, 24, &mesh));
        else
            ck_skg(skg_mesh_create_cuboid(15, 15, size, &mesh));
        add(mesh, names[which], 140 * next_random() - 70, 120 * next_random() - 60, 0);
    }
}

static skg_spectrum *tube(double kvp) {
    skg_tube t;
    skg_spectrum *spectrum = NULL;
    skg_material *aluminium = NULL;
    ck_skg(skg_material_create_element(13, &aluminium));
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 2.5};
    skg_tube_init(&t);
    t.kvp = kvp, t.filter_count = 1, t.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&t, &spectrum));
    skg_material_release(&aluminium);
    return spectrum;
}

static void take(skg_spectrum *spectrum, const skg_plan_options *options, picture *shown) {
    skg_plan *plan = NULL;
    skg_output output;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, options, &plan));
    ck_skg(skg_plan_channel_count(plan, &shown->channels));
    ck_assert_int_le(shown->channels, CHANNELS_MAX);
    for (int64_t c = 0; c < shown->channels; c++) {
        skg_channel channel;
        skg_channel_init(&channel);
        ck_skg(skg_plan_channel_get(plan, c, &channel));
        shown->open[c] = channel.flat_field;
    }
    skg_output_init(&output);
    output.data = shown->pixels;
    output.type = options->precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    ck_skg(skg_plan_image(plan, &output));
    if (output.type == SKG_TYPE_FLOAT32) /* from the end: doubles do not overwrite what is still to be read */
        for (int64_t k = shown->channels * SIDE * SIDE - 1; k >= 0; k--) {
            float pixel;
            memcpy(&pixel, (const char *)shown->pixels + (size_t)k * sizeof pixel, sizeof pixel);
            shown->pixels[k] = (double)pixel;
        }
    skg_plan_report_init(&shown->report);
    ck_skg(skg_plan_report_get(plan, &shown->report));
    skg_plan_release(&plan);
}

/* Error of a pixel as the tolerance defines it. */
static double error_of(const skg_plan_options *options, double found, double truth, double open) {
    if (options->quantity == SKG_QUANTITY_ATTENUATION) {
        found = exp(-found), truth = exp(-truth);
        open = 1;
    }
    return fabs(found - truth) / fmax(truth, 1e-6 * open);
}

static void compare(skg_spectrum *spectrum, skg_plan_options *options) {
    static picture exact, fewer;
    const double tolerance = options->tolerance;
    take(spectrum, options, &fewer);
    options->tolerance = 0;
    take(spectrum, options, &exact);
    ck_assert_int_gt(fewer.report.verified, 0);
    ck_assert_double_le(fewer.report.bound, tolerance);
    ck_assert_int_lt(fewer.report.nodes, fewer.report.bins);
    ck_assert_int_le(fewer.report.planes, exact.report.planes);
    ck_assert_int_eq(exact.report.nodes, fewer.report.bins);
    ck_assert_int_eq(exact.report.verified, 0);
    ck_assert_double_eq(exact.report.bound, 0);
    /* Single precision: exponents up to 14 carry 2^-24 of themselves from each of a few operations. */
    const double bar =
        fewer.report.bound + (options->precision == SKG_PRECISION_DOUBLE ? 1e-11 : 14 * 8 * 0x1p-24);
    for (int64_t k = 0; k < exact.channels * SIDE * SIDE; k++) {
        const double open = exact.open[k / (SIDE * SIDE)];
        ck_assert_double_le(error_of(options, fewer.pixels[k], exact.pixels[k], open), bar);
    }
}

static int has_double(void) {
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_context_device_get(context, &info));
    return info.double_precision;
}

/* Most show intensities of one channel, so that they share kernels. */
START_TEST(random_scenes) {
    static const double edges[4] = {15, 40, 65, 160};
    skg_material *air = NULL;
    skg_plan_options options;
    open_scene((uint64_t)_i + 1);
    add_parts(2 + (int)(6 * next_random()));
    skg_spectrum *spectrum = tube(60 + floor(90 * next_random()));
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    options.quantity = _i == 4  ? SKG_QUANTITY_ATTENUATION
                       : _i % 2 ? SKG_QUANTITY_PHOTONS
                                : SKG_QUANTITY_ENERGY;
    options.tolerance = pow(10, -2 - 3 * next_random());
    if (_i % 10 == 7) {
        options.quantity = SKG_QUANTITY_TRANSMISSION;
        ck_skg(skg_material_create_named("water", &air)); /* in water: what air does not show */
        options.world = air;
    }
    if (_i == 3) options.bands = 3, options.band_kev = edges;
    compare(spectrum, &options);
    skg_material_release(&air);
    skg_spectrum_release(&spectrum);
    close_scene();
}
END_TEST

/* A body that grows beyond the verified lengths is reported, and its image is still made; back within them it is not. */
START_TEST(leaving_the_verified_range) {
    static float pixels[SIDE * SIDE];
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_output output;
    skg_plan_report report;
    skg_job *job = NULL;
    const int64_t part = 0;
    double larger[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.6, 0, 0, 0, 0, 1};
    skg_frame frame;
    open_scene(5);
    add_parts(0);
    skg_spectrum *spectrum = tube(100);
    skg_plan_options_init(&options);
    options.tolerance = 1e-3;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    skg_output_init(&output);
    output.data = pixels;
    ck_skg(skg_plan_image(plan, &output));
    const float before = pixels[SIDE * SIDE / 2 + SIDE / 2];
    skg_frame_init(&frame);
    frame.pose_count = 1, frame.pose_parts = &part, frame.poses = larger;
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg_fails(skg_job_wait(&job), SKG_RANGE, "bound");
    ck_assert_ptr_null(job);
    const float after = pixels[SIDE * SIDE / 2 + SIDE / 2];
    ck_assert(after > 0 && after < before);
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert_int_gt(report.outside_pixels, SIDE);
    larger[10] = 1.2; /* within the quarter more */
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert_int_eq(report.outside_pixels, 0);
    skg_plan_release(&plan);
    skg_spectrum_release(&spectrum);
    close_scene();
}
END_TEST

/* Source and detector turned about the y axis through the origin. */
static skg_view turned(double degrees) {
    const double pi = acos(-1), c = cos(degrees * pi / 180), s = sin(degrees * pi / 180);
    skg_view one = view;
    double *vectors[] = {one.source, one.centre, one.column_step};
    for (int k = 0; k < 3; k++) {
        const double x = vectors[k][0], z = vectors[k][2];
        vectors[k][0] = c * x + s * z, vectors[k][2] = c * z - s * x;
    }
    return one;
}

/* A bar off the axis is thin at first, thick later, and out of the picture in between. */
START_TEST(views_of_a_scan_stay_within_the_range) {
    static float pixels[SIDE * SIDE];
    skg_view views[16];
    skg_mesh *mesh = NULL;
    skg_plan_options options;
    skg_output output;
    open_scene(1);
    view.column_step[0] = 3;
    ck_skg(skg_mesh_create_cuboid(120, 40, 20, &mesh));
    add(mesh, "Bone, Cortical (ICRU-44)", 30, 0, -1);
    ck_skg(skg_mesh_create_sphere(30, 24, &mesh));
    add(mesh, "Tissue, Soft (ICRU-44)", -60, 0, -1);
    skg_spectrum *spectrum = tube(100);
    skg_plan_options_init(&options);
    options.tolerance = 1e-3;
    for (int k = 0; k < 16; k++) views[k] = turned(22.5 * (k + 1));
    skg_output_init(&output);
    output.data = pixels;
    for (int planned = 0; planned < 2; planned++) {
        skg_plan *plan = NULL;
        int outside = 0;
        options.view_count = planned ? 16 : 0, options.views = planned ? views : NULL;
        ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
        for (int k = 0; k < 36; k++) {
            const skg_view one = turned(10 * k);
            ck_skg(skg_plan_view_set(plan, &one));
            const skg_status status = skg_plan_image(plan, &output);
            ck_assert(status == SKG_OK || status == SKG_RANGE);
            outside += status == SKG_RANGE;
        }
        ck_assert(planned ? outside == 0 : outside > 4);
        skg_plan_release(&plan);
    }
    options.view_count = -1;
    skg_plan *none = NULL;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &none), SKG_ERR_ARGUMENT,
                 "-1 further views");
    options.view_count = 1;
    views[0].columns = 0;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &none), SKG_ERR_SCENE,
                 "0 columns");
    skg_spectrum_release(&spectrum);
    close_scene();
}
END_TEST

/* A closed mesh may fold over itself: a ray that grazes the fold has a length below nothing. Here a cube of
 * 40 mm and beside it one of 0.5 mm turned inside out, which no coarse ray meets. */
static skg_mesh *folded(void) {
    static const int32_t corners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                           {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    double positions[16][3];
    int32_t triangles[24][3];
    skg_mesh *mesh = NULL;
    for (int v = 0; v < 16; v++)
        for (int k = 0; k < 3; k++) {
            const double half = v < 8 ? 20 : 0.25, side = v >> k & 1 ? half : -half;
            positions[v][k] = side + (v < 8 ? 0 : k == 0 ? 33 : k == 1 ? 11 : 0);
        }
    for (int t = 0; t < 24; t++)
        for (int k = 0; k < 3; k++) triangles[t][k] = t < 12 ? corners[t][k] : 8 + corners[t - 12][2 - k];
    ck_skg(skg_mesh_create(context, "folded",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 16,
                                              .positions = positions[0],
                                              .position_stride = 3,
                                              .triangles = 24,
                                              .corners = triangles[0],
                                              .triangle_stride = 3,
                                              .unit_mm = 1},
                           &mesh));
    return mesh;
}

START_TEST(a_fold_is_within_the_verified_range) {
    enum { FINE = 512 };
    static float pixels[FINE * FINE];
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_output output;
    open_scene(1);
    view.columns = view.rows = FINE;
    view.column_step[0] = view.row_step[1] = 0.3;
    add(folded(), "Bone, Cortical (ICRU-44)", 0, 0, -1);
    skg_spectrum *spectrum = tube(80);
    skg_plan_options_init(&options);
    options.tolerance = 1e-2;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    skg_output_init(&output);
    output.data = pixels;
    ck_skg(skg_plan_image(plan, &output));
    skg_channel channel;
    skg_channel_init(&channel);
    ck_skg(skg_plan_channel_get(plan, 0, &channel));
    int brighter = 0;
    for (int k = 0; k < FINE * FINE; k++) brighter += (double)pixels[k] > 1.02 * channel.flat_field;
    ck_assert_int_gt(brighter, 2); /* the fold is seen */
    skg_plan_release(&plan);
    skg_spectrum_release(&spectrum);
    close_scene();
}
END_TEST

/* The energies that a plan has chosen, given back as a beam of which every one is used. */
START_TEST(nodes_are_a_beam) {
    static picture exact, fewer, given;
    double kev[64], photons[64];
    skg_plan *plan = NULL;
    skg_plan_options options;
    open_scene(11);
    add_parts(6);
    skg_spectrum *spectrum = tube(110), *nodes = NULL;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    take(spectrum, &options, &exact);
    options.tolerance = 1e-3;
    take(spectrum, &options, &fewer);
    ck_assert_int_le(fewer.report.nodes, 64);
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    for (int64_t n = 0; n < fewer.report.nodes; n++)
        ck_skg(skg_plan_node_get(plan, n, &kev[n], &photons[n], NULL));
    skg_plan_release(&plan);
    ck_skg(skg_spectrum_create_bins(fewer.report.nodes, kev, photons, &nodes));
    options.tolerance = 0;
    take(nodes, &options, &given);
    ck_assert_int_eq(given.report.nodes, fewer.report.nodes);
    /* The tolerance asked for: the nodes' error is bounded by it. */
    for (int k = 0; k < SIDE * SIDE; k++) {
        ck_assert_double_le(error_of(&options, given.pixels[k], exact.pixels[k], exact.open[0]), 1e-3);
        /* both bounds are that tolerance */
        ck_assert_double_le(error_of(&options, given.pixels[k], fewer.pixels[k], exact.open[0]), 1e-3);
    }
    skg_spectrum_release(&nodes);
    skg_spectrum_release(&spectrum);
    close_scene();
}
END_TEST

/* A part beside the detector has no rays of the plan's view; its longest edge stands for them, so that the bound holds when a
 * frame moves the part into the view. */
START_TEST(a_part_beside_the_view_may_move_in) {
    static float pixels[SIDE * SIDE];
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_output output;
    skg_job *job = NULL;
    const int64_t part = 0;
    const double aside[16] = {1, 0, 0, 5000, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double home[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    skg_frame frame;
    open_scene(5);
    add_parts(0);
    skg_spectrum *spectrum = tube(100);
    ck_skg(skg_scene_part_pose_set(scene, part, aside));
    skg_plan_options_init(&options);
    options.tolerance = 1e-3;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    skg_output_init(&output);
    output.data = pixels;
    ck_skg(skg_plan_image(plan, &output));
    const float without = pixels[SIDE * SIDE / 2 + SIDE / 2];
    skg_frame_init(&frame);
    frame.pose_count = 1, frame.pose_parts = &part, frame.poses = home;
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    ck_assert(pixels[SIDE * SIDE / 2 + SIDE / 2] < without);
    skg_plan_release(&plan);
    skg_spectrum_release(&spectrum);
    close_scene();
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, random_scenes, 0, 20);
    tcase_add_test(tests, nodes_are_a_beam);
    tcase_add_test(tests, leaving_the_verified_range);
    tcase_add_test(tests, views_of_a_scan_stay_within_the_range);
    tcase_add_test(tests, a_part_beside_the_view_may_move_in);
    tcase_add_test(tests, a_fold_is_within_the_verified_range);
}

SKG_SUITE_MAIN("compression", add_tests)
