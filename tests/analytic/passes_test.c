/* Samples of the source that workers draw together (strategy copies) against samples that are drawn one after the other
 * (strategy tiles): sums are exact integers, and intensities are added in the same order, so that every bit is the same. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 83, ROWS = 57, PIXELS = COLUMNS * ROWS, FRAMES = 3 };

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *beam;
static skg_mesh *moving;

static void add_part(skg_mesh *mesh, const char *material, double x, double y, double z) {
    char label[16];
    int64_t count = 0;
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_scene_part_count(scene, &count));
    snprintf(label, sizeof label, "part %d", (int)count);
    part.label = label, part.mesh = mesh;
    ck_skg(skg_material_create_named(material, &part.material));
    const double c = cos(0.4), s = sin(0.4), at[3] = {x, y, z},
                 turned[3][3] = {{c, -s, 0}, {s * c, c * c, -s}, {s * s, c * s, c}};
    for (int r = 0; r < 3; r++) {
        for (int k = 0; k < 3; k++) part.pose[4 * r + k] = turned[r][k];
        part.pose[4 * r + 3] = at[r];
    }
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_material_release(&part.material);
}

/* Triangles of all sizes, a part beside the detector and one across its edge. */
static void open_scene(void) {
    static const double energies[3] = {40, 60, 90}, photons[3] = {5000, 9000, 8000};
    skg_mesh *box = NULL, *ball = NULL, *fine = NULL;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_mesh_create_cuboid(30, 24, 20, &box));
    ck_skg(skg_mesh_create_sphere(14, 12, &ball));
    ck_skg(skg_mesh_create_sphere(11, 60, &fine));
    ck_skg(skg_mesh_create_sphere(9, 24, &moving));
    add_part(box, "Water", -6, 2, 1);
    add_part(ball, "Al", 9, -4, 40);
    add_part(fine, "Bone, Cortical (ICRP)", 20, 12, -30);
    add_part(moving, "Al", -27, -20, 0);
    add_part(ball, "Water", 200, 0, 0);
    ck_skg(skg_spectrum_create_bins(3, energies, photons, &beam));
    skg_mesh_release(&box);
    skg_mesh_release(&ball);
    skg_mesh_release(&fine);
}

static void close_scene(void) {
    skg_mesh_release(&moving);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

static skg_view view_of(double shift) {
    skg_view view;
    skg_view_init(&view);
    view.columns = COLUMNS, view.rows = ROWS;
    view.source[0] = 3 + shift, view.source[2] = -300;
    view.centre[2] = 150;
    view.column_step[0] = 90.0 / COLUMNS, view.column_step[2] = 0.01;
    view.row_step[1] = 80.0 / ROWS;
    return view;
}

/* Some frames in one batch: views, a part that moves, and seeds of the noise. */
static void take(skg_plan *plan, float *images) {
    static const int64_t moves[1] = {1};
    double poses[FRAMES][16];
    skg_view views[FRAMES];
    skg_frame frames[FRAMES];
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.data = images;
    for (int f = 0; f < FRAMES; f++) {
        const double pose[16] = {1, 0, 0, 7 + 3.0 * f, 0, 1, 0, -3.0 * f, 0, 0, 1, 30, 0, 0, 0, 1};
        memcpy(poses[f], pose, sizeof pose);
        views[f] = view_of(2 * f);
        skg_frame_init(&frames[f]);
        frames[f].view = &views[f];
        frames[f].pose_count = f > 0, frames[f].pose_parts = moves, frames[f].poses = poses[f];
        frames[f].noise_seed = f;
    }
    ck_skg(skg_plan_submit(plan, FRAMES, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

/* Compares the images of both strategies; the second time after vertices have moved. */
static void compare(skg_plan_options *options, int samples) {
    static float images[2][2][FRAMES * PIXELS];
    static const int32_t strategies[2] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES};
    skg_plan *plans[2] = {NULL, NULL};
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = 2, spot.extent[1] = 1, spot.samples = samples;
    options->overlaps = 0;
    options->spot = &spot;
    const skg_view view = view_of(0);
    for (int s = 0; s < 2; s++) {
        options->strategy = strategies[s];
        ck_skg(skg_plan_create(context, scene, &view, beam, options, &plans[s]));
        take(plans[s], images[0][s]);
    }
    int64_t vertices = 0, triangles = 0;
    ck_skg(skg_mesh_count(moving, &vertices, &triangles));
    double *positions = malloc((size_t)vertices * 3 * sizeof *positions);
    ck_assert_ptr_nonnull(positions);
    ck_skg(skg_mesh_positions_get(moving, positions, 0));
    for (int64_t k = 0; k < 3 * vertices; k++) positions[k] *= 1.01;
    ck_skg(skg_mesh_positions_set(moving, positions, 0));
    free(positions);
    for (int s = 0; s < 2; s++) take(plans[s], images[1][s]);
    for (int s = 0; s < 2; s++) skg_plan_release(&plans[s]);
    for (int turn = 0; turn < 2; turn++)
        ck_assert_msg(memcmp(images[turn][0], images[turn][1], sizeof images[0][0]) == 0,
                      "%d samples, turn %d", samples, turn);
    ck_assert(memcmp(images[0][0], images[1][0], sizeof images[0][0]) != 0);
}

/* One sample for each worker, four side by side, both with a last turn that is not full, and numbers that leave workers idle. */
START_TEST(samples_together_and_one_by_one) {
    static const int samples[] = {2, 4, 5, 7, 8, 15, 16, 33};
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++) {
        skg_plan_options options;
        skg_plan_options_init(&options);
        options.tolerance = _i % 2 ? 1e-3 : 0;
        options.precision = _i & 2 ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
        compare(&options, samples[k]);
    }
}
END_TEST

START_TEST(samples_with_effects) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.noise = 1;
    options.falloff = 1;
    compare(&options, 16);
    skg_plan_options_init(&options);
    ck_skg(skg_material_create_named("Air", &options.world));
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.supersampling = 2;
    compare(&options, 4);
    skg_material_release(&options.world);
}
END_TEST

/* Where the source stands in a part, what lies at its plane has a kernel of its own: such samples are drawn one by one. */
START_TEST(samples_in_a_part) {
    skg_plan_options options;
    skg_mesh *shell = NULL;
    skg_plan_options_init(&options);
    ck_skg(skg_mesh_create_cuboid(60, 60, 60, &shell));
    add_part(shell, "Air", 0, 0, -300);
    skg_mesh_release(&shell);
    compare(&options, 16);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_loop_test(tests, samples_together_and_one_by_one, 0, 4);
    tcase_add_test(tests, samples_with_effects);
    tcase_add_test(tests, samples_in_a_part);
}

SKG_SUITE_MAIN("passes", add_tests)
