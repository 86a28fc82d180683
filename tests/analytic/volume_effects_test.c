/* Volumes of cells beside the other effects: a block of water as cells gives what one of triangles gives. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE, COLUMNS = 4, ROWS = 3, SLICES = 2, CELLS = COLUMNS * ROWS * SLICES };

static skg_context *context;
static skg_spectrum *beam;
static skg_view view;
static skg_material *water, *air, *metal;
static skg_scene *scenes[2]; /* of triangles, of cells */

static void add_mesh(skg_scene *scene, const char *label, skg_mesh *mesh, skg_material *material, double x,
                     int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    part.label = label, part.mesh = mesh, part.material = material, part.inside = inside;
    part.pose[3] = x;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&mesh);
}

static void add_block(skg_scene *scene, int of_cells) {
    static uint16_t cells[CELLS];
    skg_volume_source source;
    skg_mesh *mesh = NULL;
    skg_part part;
    if (!of_cells) {
        ck_skg(skg_mesh_create_cuboid(40, 30, 20, &mesh));
        add_mesh(scene, "block", mesh, water, 0, -1);
        return;
    }
    for (int k = 0; k < CELLS; k++) cells[k] = 1;
    skg_part_init(&part);
    skg_volume_source_init(&source);
    source.columns = COLUMNS, source.rows = ROWS, source.slices = SLICES;
    source.cells = cells, source.type = SKG_VOLUME_UINT16, source.values = SKG_VOLUME_DENSITY;
    source.material = water;
    for (int k = 0; k < 3; k++) source.affine[5 * k] = 10;
    source.affine[3] = -15, source.affine[7] = -10, source.affine[11] = -5;
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = "block";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
}

static void open_context(void) {
    static const double kev[3] = {40, 60, 90}, photons[3] = {100, 200, 50};
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_spectrum_create_bins(3, kev, photons, &beam));
    ck_skg(skg_material_create_named("Water", &water));
    ck_skg(skg_material_create_named("Air", &air));
    ck_skg(skg_material_create_named("Ti", &metal));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = 30, view.source[1] = 20, view.source[2] = -300;
    view.centre[2] = 100;
    view.column_step[0] = view.row_step[1] = 3;
    for (int k = 0; k < 2; k++) {
        skg_mesh *rod = NULL;
        ck_skg(skg_scene_create(context, &scenes[k]));
        add_block(scenes[k], k);
        ck_skg(skg_mesh_create_cylinder(4, 12, 48, &rod));
        add_mesh(scenes[k], "rod", rod, metal, 6, 0);
    }
}

static void close_context(void) {
    for (int k = 0; k < 2; k++) skg_scene_release(&scenes[k]);
    skg_material_release(&water);
    skg_material_release(&air);
    skg_material_release(&metal);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

static void compare(const double *cells, const double *triangles, double bar) {
    double worst = 0, most = 0, least = HUGE_VAL;
    for (int p = 0; p < PIXELS; p++) {
        worst = fmax(worst, fabs(cells[p] - triangles[p]));
        most = fmax(most, fabs(triangles[p])), least = fmin(least, fabs(triangles[p]));
    }
    ck_assert_double_lt(least, most);
    ck_assert_msg(worst <= bar * most, "worst %g of %g", worst, most);
}

static void render(skg_plan *plan, const skg_frame *frame, int32_t kind, double *image) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image, output.kind = kind;
    ck_skg(skg_plan_submit(plan, 1, frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

/* The effect of test number i: what changes the rays, the image behind them, or what is around. */
static void set_effect(int i, skg_plan_options *options, skg_spot *spot, skg_detector_blur *blur) {
    static const double line[3] = {0.2, 1, 0.3};
    skg_spot_init(spot);
    skg_detector_blur_init(blur);
    spot->shape = SKG_SPOT_RECTANGLE, spot->extent[0] = spot->extent[1] = 2, spot->samples = 4;
    blur->columns = blur->rows = 3, blur->along_row = blur->along_column = line;
    if (i == 0) options->spot = spot;
    if (i == 1) options->supersampling = 3;
    if (i == 2) options->blur = blur, options->falloff = SKG_FALLOFF_ON;
    if (i == 3) options->world = air;
    if (i == 4) options->clip = 1;
    if (i == 5) options->noise = 1, options->noise_seed = 7;
    if (i == 6)
        options->spot = spot, options->supersampling = 2, options->world = air, options->tolerance = 1e-4;
}

/* From the eighth on a curved detector sees both: several samples of the source, blur, the variance of noise, and 16 passes a frame. */
enum { EFFECTS = 7, CURVED = 4 };

START_TEST(effects_are_those_of_meshes) {
    static const int curved[CURVED] = {0, 2, 5, 6};
    static double images[2][PIXELS];
    const int effect = _i < EFFECTS ? _i : curved[_i - EFFECTS];
    skg_plan_options options;
    skg_spot spot;
    skg_detector_blur blur;
    view.radius = _i < EFFECTS ? 0 : 250;
    for (int k = 0; k < 2; k++) {
        skg_plan *plan = NULL;
        skg_plan_options_init(&options);
        set_effect(effect, &options, &spot, &blur);
        if (effect == 5) { /* noise: its draws hang on the last bits, so the variance is compared */
            ck_skg(skg_plan_create(context, scenes[k], &view, beam, &options, &plan));
            render(plan, NULL, SKG_OUTPUT_VARIANCE, images[k]);
        } else {
            ck_skg(skg_plan_create(context, scenes[k], &view, beam, &options, &plan));
            render(plan, NULL, SKG_OUTPUT_IMAGE, images[k]);
        }
        skg_plan_release(&plan);
    }
    /* Rounded faces of meshes; with a tolerance that of both spectra. */
    compare(images[1], images[0], effect == 6 ? 2e-4 : 3e-6);
}
END_TEST

/* Frames with poses of their own, another view and another material of the rod: the plan stays. */
START_TEST(plans_go_on) {
    static double images[2][PIXELS], moved[2][PIXELS], lead[2][PIXELS];
    static const double pose[32] = {0.8, -0.6, 0, 9, 0.6, 0.8, 0, -4, 0, 0, 1, 5, 0, 0, 0, 1,
                                    0.8, -0.6, 0, 9, 0.6, 0.8, 0, -4, 0, 0, 1, 5, 0, 0, 0, 1};
    static const int64_t parts[2] = {0, 1};
    skg_material *pb = NULL;
    skg_frame frame;
    ck_skg(skg_material_create_named("Pb", &pb));
    for (int k = 0; k < 2; k++) {
        skg_plan *plan = NULL;
        ck_skg(skg_plan_create(context, scenes[k], &view, beam, NULL, &plan));
        skg_frame_init(&frame);
        frame.pose_count = 2, frame.pose_parts = parts, frame.poses = pose;
        render(plan, &frame, SKG_OUTPUT_IMAGE, moved[k]);
        ck_skg(skg_scene_part_material_set(scenes[k], 1, pb));
        render(plan, NULL, SKG_OUTPUT_IMAGE, lead[k]);
        ck_skg(skg_scene_part_material_set(scenes[k], 1, metal));
        render(plan, NULL, SKG_OUTPUT_IMAGE, images[k]);
        skg_plan_release(&plan);
    }
    compare(images[1], images[0], 3e-6);
    compare(moved[1], moved[0], 3e-6);
    compare(lead[1], lead[0], 3e-6);
    ck_assert_int_ne(memcmp(lead[1], images[1], sizeof images[1]), 0);
    ck_assert_int_ne(memcmp(moved[1], images[1], sizeof images[1]), 0);
    skg_material_release(&pb);
}
END_TEST

/* Lengths through a volume are those through its box, without what lies inside. */
START_TEST(lengths_are_those_of_the_box) {
    static double lengths[2][PIXELS];
    for (int k = 0; k < 2; k++) {
        skg_plan *plan = NULL;
        ck_skg(skg_plan_create(context, scenes[k], &view, beam, NULL, &plan));
        render(plan, NULL, SKG_OUTPUT_LENGTHS, lengths[k]);
        skg_plan_release(&plan);
    }
    compare(lengths[1], lengths[0], 3e-6);
}
END_TEST

/* A leaky mesh elsewhere has planes of its own, which are added to the same sums. */
START_TEST(leaky_meshes_stand_beside) {
    static const double corners[15] = {-9, -9, 30, 9, -9, 30, 9, 9, 30, -9, 9, 30, 0, 0, 45};
    static const int32_t triangles[15] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 2, 1}; /* one is missing */
    static double images[2][PIXELS];
    skg_mesh_source source;
    skg_mesh_source_init(&source);
    source.vertices = 5, source.positions = corners, source.triangles = 5, source.corners = triangles;
    for (int k = 0; k < 2; k++) {
        skg_plan *plan = NULL;
        skg_mesh *tent = NULL;
        ck_skg(skg_mesh_create(NULL, "tent", &source, &tent));
        add_mesh(scenes[k], "tent", tent, metal, 0, -1);
        ck_skg(skg_plan_create(context, scenes[k], &view, beam, NULL, &plan));
        render(plan, NULL, SKG_OUTPUT_IMAGE, images[k]);
        skg_plan_release(&plan);
    }
    compare(images[1], images[0], 3e-6);
}
END_TEST

/* A volume in a volume in a bath, each of which displaces what it lies in. */
START_TEST(volumes_lie_in_each_other) {
    static double images[2][PIXELS];
    static const double sizes[2] = {20, 8};
    for (int k = 0; k < 2; k++) {
        skg_scene *scene = NULL;
        skg_plan *plan = NULL;
        skg_mesh *mesh = NULL;
        ck_skg(skg_scene_create(context, &scene));
        ck_skg(skg_mesh_create_cuboid(50, 50, 50, &mesh));
        add_mesh(scene, "bath", mesh, air, 0, -1);
        for (int v = 0; v < 2; v++) {
            static const uint16_t one = 1;
            skg_volume_source source;
            skg_part part;
            if (!k) {
                ck_skg(skg_mesh_create_cuboid(sizes[v], sizes[v], sizes[v], &mesh));
                add_mesh(scene, v ? "inner" : "outer", mesh, v ? metal : water, v ? 3 : 0, v);
                continue;
            }
            skg_part_init(&part);
            skg_volume_source_init(&source);
            source.columns = source.rows = source.slices = 1, source.cells = &one,
            source.type = SKG_VOLUME_UINT16;
            source.values = SKG_VOLUME_DENSITY, source.material = v ? metal : water;
            for (int a = 0; a < 3; a++) source.affine[5 * a] = sizes[v];
            ck_skg(skg_volume_create(&source, &part.volume));
            part.label = v ? "inner" : "outer", part.inside = v, part.pose[3] = v ? 3 : 0;
            ck_skg(skg_scene_part_add(scene, &part, NULL));
            skg_volume_release(&part.volume);
        }
        if (!k) { /* the cells have 1 g/cm3 */
            skg_material *light = NULL;
            ck_skg(skg_material_create_at_density(metal, 1, &light));
            ck_skg(skg_scene_part_material_set(scene, 2, light));
            skg_material_release(&light);
        }
        ck_skg(skg_plan_create(context, scene, &view, beam, NULL, &plan));
        render(plan, NULL, SKG_OUTPUT_IMAGE, images[k]);
        skg_plan_release(&plan);
        skg_scene_release(&scene);
    }
    compare(images[1], images[0], 3e-6);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_loop_test(tests, effects_are_those_of_meshes, 0, EFFECTS + CURVED);
    tcase_add_test(tests, plans_go_on);
    tcase_add_test(tests, lengths_are_those_of_the_box);
    tcase_add_test(tests, volumes_lie_in_each_other);
    tcase_add_test(tests, leaky_meshes_stand_beside);
}

SKG_SUITE_MAIN("volume_effects", add_tests)
