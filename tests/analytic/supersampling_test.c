/* Supersampled pixels: one pass on a finer detector against the mean of single images on shifted detectors, which know nothing
 * of it. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { COLUMNS_MAX = 75, ROWS_MAX = 53, LIMIT = COLUMNS_MAX * ROWS_MAX };

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *beam;
static double image[LIMIT], mean[LIMIT];

static void add_part(const char *label, skg_mesh *mesh, const char *material, const double at[3],
                     int32_t priority) {
    skg_part part;
    skg_part_init(&part);
    part.label = label, part.mesh = mesh, part.priority = priority;
    ck_skg(skg_material_create_named(material, &part.material));
    /* Turned by angles whose faces lie along no ray. */
    const double c = cos(0.4), s = sin(0.4),
                 turned[3][3] = {{c, -s, 0}, {s * c, c * c, -s}, {s * s, c * s, c}};
    for (int r = 0; r < 3; r++) {
        for (int k = 0; k < 3; k++) part.pose[4 * r + k] = turned[r][k];
        part.pose[4 * r + 3] = at[r];
    }
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
}

static void open_scene(void) {
    static const double energies[2] = {40, 90}, photons[2] = {5000, 8000}, here[3] = {-6, 2, 1};
    skg_mesh *box = NULL;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_mesh_create_cuboid(30, 24, 20, &box));
    add_part("box", box, "Water", here, 0);
    ck_skg(skg_spectrum_create_bins(2, energies, photons, &beam));
}

/* A ball that overlaps the box, and takes its place there if it has a priority. */
static void add_ball(int32_t priority) {
    static const double there[3] = {9, -4, 8};
    skg_mesh *ball = NULL;
    ck_skg(skg_mesh_create_sphere(14, 24, &ball));
    add_part("ball", ball, "Al", there, priority);
}

static void close_scene(void) {
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

static skg_view view_of(int64_t columns, int64_t rows) {
    skg_view view;
    skg_view_init(&view);
    view.columns = columns, view.rows = rows;
    view.source[0] = 3, view.source[2] = -300;
    view.centre[2] = 150;
    view.column_step[0] = 90.0 / (double)columns, view.column_step[2] = 0.01;
    view.row_step[1] = 80.0 / (double)rows;
    return view;
}

static void take(const skg_plan_options *options, const skg_view *view, double *to, skg_plan_report *report) {
    skg_plan *plan = NULL;
    skg_output output;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = to;
    ck_skg(skg_plan_create(context, scene, view, beam, options, &plan));
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_report_init(report);
    ck_skg(skg_plan_report_get(plan, report));
    skg_plan_release(&plan);
}

/* Gets the plan's reason for its supersampling. */
static void explain(const skg_plan_options *options, const skg_view *view, char reason[256]) {
    skg_plan *plan = NULL;
    skg_effect effect;
    int64_t count = 0;
    skg_effect_init(&effect);
    reason[0] = '\0';
    ck_skg(skg_plan_create(context, scene, view, beam, options, &plan));
    ck_skg(skg_plan_effect_count(plan, &count));
    for (int64_t k = 0; k < count; k++) {
        ck_skg(skg_plan_effect_get(plan, k, &effect));
        if (strcmp(effect.name, "supersampling") == 0) snprintf(reason, 256, "%s", effect.reason);
    }
    skg_plan_release(&plan);
}

/* The mean over n x n detectors, each moved by the shift of one ray of a pixel. */
static void take_mean(const skg_plan_options *plain, const skg_view *view, int n) {
    static double one[LIMIT];
    skg_plan_report report;
    memset(mean, 0, sizeof mean);
    for (int k = 0; k < n * n; k++) {
        skg_view moved = *view;
        const double right = (k % n + 0.5) / n - 0.5, down = (k / n + 0.5) / n - 0.5;
        for (int d = 0; d < 3; d++)
            moved.centre[d] += right * view->column_step[d] + down * view->row_step[d];
        take(plain, &moved, one, &report);
        for (int64_t p = 0; p < view->columns * view->rows; p++) mean[p] += one[p] / (n * n);
    }
}

typedef struct {
    int n;
    int64_t columns, rows;
    int32_t precision, quantity, falloff, spot;
    double error; /* of a pixel, as a share of the greatest */
} sampled;

/* Single: the positions of rays are rounded to 4 units of 2^-24 of a part's 50 pixels, on both ways differently. Lengths that
 * change by 60 mm a pixel at the ball's silhouette are off by some 2e-3 mm, and images with mu 0.15/mm by 3e-4, over the n x n
 * rays of a pixel less than 1e-4. Double: 2^29 times less. Half: a step of an exit's distance is 0.25 mm, of the ball and of
 * the box, rounded alike but for such rays; the image is rounded to 2^-11. */
static const sampled cases[] = {
    {2, 64, 48, 0, SKG_QUANTITY_ENERGY, 0, 0, 1e-4},
    {2, 75, 53, 0, SKG_QUANTITY_TRANSMISSION, 0, 0, 1e-4},
    {3, 67, 31, 0, SKG_QUANTITY_FLUENCE, 1, 0, 1e-4},
    {4, 33, 21, 0, SKG_QUANTITY_PHOTONS, 0, 1, 1e-4},
    {5, 17, 9, 0, SKG_QUANTITY_ENERGY, 1, 0, 1e-4},
    {2, 75, 53, SKG_PRECISION_DOUBLE, SKG_QUANTITY_ENERGY, 0, 0, 1e-11},
    {3, 33, 21, SKG_PRECISION_DOUBLE, SKG_QUANTITY_TRANSMISSION, 0, 1, 1e-11},
    {2, 64, 48, SKG_PRECISION_HALF, SKG_QUANTITY_TRANSMISSION, 0, 0, 0x1p-11},
};
enum { CASES = sizeof cases / sizeof *cases };

static void choose(const sampled *c, skg_plan_options *options, skg_spot *spot) {
    skg_plan_options_init(options);
    options->precision = c->precision, options->quantity = c->quantity, options->falloff = c->falloff;
    skg_spot_init(spot);
    spot->shape = SKG_SPOT_RECTANGLE, spot->extent[0] = 1, spot->extent[1] = 2, spot->grid = 2;
    /* Towards the same point of the detector from each shifted one. */
    spot->axis[2] = 1;
    if (c->spot) options->spot = spot;
}

START_TEST(one_pass_is_the_mean_of_shifted_detectors) {
    const sampled *c = &cases[_i];
    const skg_view view = view_of(c->columns, c->rows);
    skg_plan_options options, plain;
    skg_spot spot;
    skg_plan_report report;
    char reason[256];
    add_ball(c->precision == SKG_PRECISION_HALF ? 0 : 1);
    choose(c, &options, &spot);
    plain = options;
    options.supersampling = c->n;
    explain(&options, &view, reason);
    ck_assert_ptr_nonnull(strstr(reason, "all in one pass"));
    take(&options, &view, image, &report);
    ck_assert_int_eq(report.samples, c->n * c->n * (c->spot ? 4 : 1));
    take_mean(&plain, &view, c->n);
    double greatest = 0, worst = 0;
    for (int64_t p = 0; p < c->columns * c->rows; p++) {
        greatest = fmax(greatest, mean[p]);
        worst = fmax(worst, fabs(image[p] - mean[p]));
    }
    ck_assert_double_le(worst, c->error * greatest);
}
END_TEST

/* Strategies, tiles and the rows of the caller's memory change no bit. */
START_TEST(strategies_agree) {
    static const struct {
        int32_t strategy, tile;
    } ways[] = {{SKG_STRATEGY_COPIES, 0},
                {SKG_STRATEGY_TILES, 0},
                {SKG_STRATEGY_TILES, 8},
                {SKG_STRATEGY_ATOMICS, 0}};
    const skg_view view = view_of(67, 31);
    skg_plan_options options;
    skg_plan_report report;
    add_ball(1);
    skg_plan_options_init(&options);
    options.supersampling = 2 + _i;
    options.noise = _i == 1;
    take(&options, &view, image, &report);
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        options.strategy = ways[k].strategy, options.tile = ways[k].tile;
        take(&options, &view, mean, &report);
        ck_assert_mem_eq(image, mean, (size_t)(view.columns * view.rows) * sizeof *image);
    }
}
END_TEST

/* Each ray has the noise that a pass of its own has: its variance is that of the photons of the whole pixel, and -ln is taken
 * of the mean. */
START_TEST(attenuation_is_that_of_the_mean) {
    const skg_view view = view_of(64, 48);
    skg_plan_options options;
    skg_plan_report report;
    add_ball(1);
    skg_plan_options_init(&options);
    options.supersampling = 3, options.quantity = SKG_QUANTITY_TRANSMISSION;
    take(&options, &view, mean, &report);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    take(&options, &view, image, &report);
    for (int64_t p = 0; p < view.columns * view.rows; p++)
        ck_assert_double_eq_tol(image[p], -log(mean[p]), 1e-6); /* 9 sums and a logarithm in single */
}
END_TEST

/* Path lengths are those of the pixels' centres, with and without supersampling. */
START_TEST(lengths_have_one_ray_a_pixel) {
    const skg_view view = view_of(75, 53);
    skg_plan_options options;
    add_ball(0);
    skg_plan_options_init(&options);
    for (int32_t n = 1; n <= 3; n += 2) {
        skg_plan *plan = NULL;
        skg_job *job = NULL;
        skg_output output;
        skg_output_init(&output);
        output.type = SKG_TYPE_FLOAT64, output.data = n == 1 ? mean : image;
        options.supersampling = n;
        ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
        output.kind = SKG_OUTPUT_LENGTHS;
        output.part = 1;
        output.lengths = SKG_LENGTHS_SURFACE;
        ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        skg_plan_release(&plan);
    }
    ck_assert_mem_eq(image, mean, (size_t)(view.columns * view.rows) * sizeof *image);
}
END_TEST

static char lines[4][256];
static int line_count;

/* Keeps warnings; that kernels are being compiled is another level. */
static void keep_line(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING && line_count < 4)
        snprintf(lines[line_count++], sizeof *lines, "%s", sentence);
}

/* How far a shadow misses the detector is said in pixels of the image. */
START_TEST(misses_are_told_in_pixels_of_the_image) {
    skg_plan_options options;
    skg_plan_report report;
    skg_view view = view_of(33, 21);
    view.centre[0] += 400;
    skg_plan_options_init(&options);
    ck_skg(skg_context_log_set(context, keep_line, NULL));
    line_count = 0;
    take(&options, &view, mean, &report);
    options.supersampling = 3;
    take(&options, &view, image, &report);
    ck_skg(skg_context_log_set(context, NULL, NULL));
    ck_assert_int_eq(line_count, 2);
    const char *numbers[2] = {strstr(lines[0], "lies "), strstr(lines[1], "lies ")};
    double pixels[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        ck_assert_ptr_nonnull(numbers[k]);
        ck_assert_int_eq(sscanf(numbers[k], "lies %lf pixels", &pixels[k]), 1);
    }
    ck_assert_double_ge(pixels[0], 50);
    /* Of the edge of the pixels, in one of the cases by half a third of a pixel; printed with four digits. */
    ck_assert_double_eq_tol(pixels[0], pixels[1], 0.4);
}
END_TEST

/* Leaky meshes are repaired in pixels of the image: passes. */
START_TEST(leaky_meshes_take_passes) {
    static const double positions[12] = {0, 0, 0, 20, 0, 0, 0, 20, 0, 0, 0, 20};
    static const int32_t corners[9] = {0, 2, 1, 0, 1, 3, 0, 3, 2};
    static const double here[3] = {-20, -20, 20};
    const skg_view view = view_of(33, 21);
    skg_mesh *mesh = NULL;
    skg_plan_options options;
    skg_plan_report report;
    char reason[256];
    ck_skg(skg_mesh_create(context, "open",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = 4,
                                              .positions = positions,
                                              .triangles = 3,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &mesh));
    add_part("open", mesh, "Water", here, 0);
    skg_plan_options_init(&options);
    options.repair = SKG_REPAIR_NONE;
    skg_plan_options plain = options;
    options.supersampling = 2;
    explain(&options, &view, reason);
    ck_assert_ptr_nonnull(strstr(reason, "leaky meshes"));
    take(&options, &view, image, &report);
    take_mean(&plain, &view, 2);
    for (int64_t p = 0; p < view.columns * view.rows; p++) /* the same rays: roundings of floats */
        ck_assert_double_eq_tol(image[p], mean[p], 1e-6 * 920000);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_loop_test(tests, one_pass_is_the_mean_of_shifted_detectors, 0, CASES);
    tcase_add_loop_test(tests, strategies_agree, 0, 3);
    tcase_add_test(tests, attenuation_is_that_of_the_mean);
    tcase_add_test(tests, lengths_have_one_ray_a_pixel);
    tcase_add_test(tests, misses_are_told_in_pixels_of_the_image);
    tcase_add_test(tests, leaky_meshes_take_passes);
}

SKG_SUITE_MAIN("supersampling", add_tests)
