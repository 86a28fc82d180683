/* Matter of the cells of volumes, beside meshes of the same matter; and volumes that are refused. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    SIDE = 32,
    PIXELS = SIDE * SIDE,
    COLUMNS = 3,
    ROWS = 2,
    SLICES = 4,
    CELLS = COLUMNS * ROWS * SLICES,
    BINS = 40
};

static skg_context *context;
static skg_spectrum *beam;
static skg_view view;
/* From air to bone, with a row of Schneider's table for each. */
static const int16_t numbers[CELLS] = {-1000, -980, -700, -120, -60,  -10,  20,   60,   110,  250, 330, 480,
                                       560,   690,  850,  990,  1100, 1210, 1320, 1430, 1540, 40,  0,   -300};
static const double affine[16] = {12, 0, 0, -12, 0, 14, 0, -7, 0, 0, 9, -13.5, 0, 0, 0, 1};

static void open_context(void) {
    double energies[BINS], photons[BINS];
    ck_skg(skg_context_create(NULL, &context));
    for (int k = 0; k < BINS; k++) energies[k] = 20 + 2 * k, photons[k] = 100 + k * (BINS - k);
    ck_skg(skg_spectrum_create_bins(BINS, energies, photons, &beam));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = 20, view.source[1] = 35, view.source[2] = -400;
    view.centre[2] = 100;
    view.column_step[0] = view.row_step[1] = 2.1;
}

static void close_context(void) {
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

static skg_scene *make_scene(void) {
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(context, &scene));
    return scene;
}

static void add_volume(skg_scene *scene, const skg_volume_source *source, int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    part.label = "volume", part.inside = inside;
    ck_skg(skg_volume_create(source, &part.volume));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
}

/* Takes over mesh and material. */
static void add_mesh(skg_scene *scene, const char *label, skg_mesh *mesh, skg_material *material,
                     const double at[3], int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    part.label = label, part.mesh = mesh, part.material = material, part.inside = inside;
    for (int k = 0; k < 3; k++) part.pose[4 * k + 3] = at[k];
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&mesh);
    skg_material_release(&material);
}

static void source_of(skg_volume_source *source, const void *cells, int32_t type, int32_t values) {
    skg_volume_source_init(source);
    source->columns = COLUMNS, source->rows = ROWS, source->slices = SLICES;
    source->cells = cells, source->type = type, source->values = values;
    memcpy(source->affine, affine, sizeof affine);
}

static skg_status render(skg_context *on, skg_scene *scene, const skg_plan_options *options, double *image) {
    skg_plan *plan = NULL;
    skg_output output;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    const skg_status status = skg_plan_create(on, scene, &view, beam, options, &plan);
    if (status != SKG_OK) return status;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
    return SKG_OK;
}

static double worst_of(const double *a, const double *b) {
    double worst = 0, most = 0;
    for (int p = 0; p < PIXELS; p++) worst = fmax(worst, fabs(a[p] - b[p])), most = fmax(most, fabs(b[p]));
    ck_assert_double_gt(most, 0.1);
    return worst / most;
}

static skg_scene *scene_of_boxes(void) {
    skg_scene *scene = make_scene();
    for (int k = 0; k < CELLS; k++) {
        const int at[3] = {k % COLUMNS, k / COLUMNS % ROWS, k / COLUMNS / ROWS};
        double place[3];
        char label[32];
        skg_mesh *mesh = NULL;
        skg_material *material = NULL;
        for (int a = 0; a < 3; a++) place[a] = affine[5 * a] * at[a] + affine[4 * a + 3];
        snprintf(label, sizeof label, "cell %d", k);
        ck_skg(skg_mesh_create_cuboid(affine[0], affine[5], affine[10], &mesh));
        ck_skg(skg_material_create_hounsfield(numbers[k], &material));
        add_mesh(scene, label, mesh, material, place, -1);
    }
    return scene;
}

START_TEST(hounsfield_numbers_are_schneiders_tissues) {
    static double cells[PIXELS], boxes[PIXELS], exact[PIXELS], wide[PIXELS];
    double densities[CELLS];
    skg_scene *of_cells = make_scene(), *of_boxes = scene_of_boxes();
    skg_plan_options options;
    skg_volume_source source;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    source_of(&source, numbers, SKG_VOLUME_INT16, SKG_VOLUME_HU);
    add_volume(of_cells, &source, -1);
    ck_skg(render(context, of_boxes, &options, exact));
    ck_skg(render(context, of_cells, &options, cells));
    /* 20 compositions have 20 planes of floats; the faces of meshes are rounded (docs/numerics.md). */
    ck_assert_double_lt(worst_of(cells, exact), 2e-6);
    options.tolerance = 1e-3;
    ck_skg(render(context, of_boxes, &options, boxes));
    ck_skg(render(context, of_cells, &options, cells));
    /* The tolerance that was asked for. */
    ck_assert_double_lt(worst_of(cells, exact), 1e-3);
    ck_assert_double_lt(worst_of(boxes, exact), 1e-3);
    /* Values with decimals become whole numbers. */
    for (int k = 0; k < CELLS; k++) densities[k] = numbers[k] + 0.3;
    skg_scene *rounded = make_scene();
    source_of(&source, densities, SKG_VOLUME_FLOAT64, SKG_VOLUME_HU);
    add_volume(rounded, &source, -1);
    ck_skg(render(context, rounded, &options, wide));
    ck_assert_mem_eq(wide, cells, sizeof cells);
    skg_scene_release(&of_cells);
    skg_scene_release(&of_boxes);
    skg_scene_release(&rounded);
}
END_TEST

/* A cube of water, as cells with the water's density in 16 and in 32 bits and with classes, beside the mesh. */
START_TEST(water_is_water) {
    static double cells[PIXELS], cube[PIXELS];
    static const double middle[3] = {0, 0, 0}, limits[2] = {0, 2};
    uint16_t whole[CELLS];
    float half[CELLS];
    skg_mesh *mesh = NULL;
    skg_material *classes[2] = {NULL, NULL}, *water = NULL;
    skg_plan_options options;
    skg_plan_options_init(&options);
    ck_skg(skg_mesh_create_cuboid(36, 28, 36, &mesh));
    ck_skg(skg_material_create_named("Water", &classes[0]));
    ck_skg(skg_material_create_named("Pb", &classes[1]));
    ck_skg(skg_material_create_at_density(classes[0], _i == 1 ? 0.7 : 1, &water));
    skg_scene *of_mesh = make_scene();
    add_mesh(of_mesh, "water", mesh, water, middle, -1);
    ck_skg(render(context, of_mesh, &options, cube));
    for (int k = 0; k < CELLS; k++) whole[k] = 1, half[k] = 0.7f;
    for (int classed = 0; classed < 2; classed++) {
        skg_volume_source source;
        skg_scene *scene = make_scene();
        source_of(&source, _i ? (const void *)half : whole, _i ? SKG_VOLUME_FLOAT32 : SKG_VOLUME_UINT16,
                  SKG_VOLUME_DENSITY);
        if (classed)
            source.class_count = 2, source.class_from = limits, source.class_materials = classes;
        else
            source.material = classes[0];
        add_volume(scene, &source, -1);
        ck_skg(render(context, scene, &options, cells));
        /* The faces of meshes are rounded, as above. */
        ck_assert_double_lt(worst_of(cells, cube), 2e-6);
        skg_scene_release(&scene);
    }
    skg_material_release(&classes[0]);
    skg_material_release(&classes[1]);
    skg_scene_release(&of_mesh);
}
END_TEST

/* A cylinder of cells of 0.25 mm has the mean attenuation of one of triangles, and a rod of titanium in a bath of cells the image of one in
 * a bath of triangles. */
START_TEST(cells_stand_for_meshes) {
    enum { N = 96 };
    static uint16_t cells[N * N * N];
    static double image[PIXELS], other[PIXELS];
    static const double middle[3] = {0, 0, 0}, aside[3] = {3, 0, -4};
    double sums[2] = {0, 0};
    skg_volume_source source;
    skg_mesh *mesh = NULL;
    skg_material *material = NULL;
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    for (int k = 0; k < N * N * N; k++) {
        const double x = (k % N - 0.5 * (N - 1)) * 0.25, y = (k / N % N - 0.5 * (N - 1)) * 0.25;
        cells[k] = _i || x * x + y * y < 100;
    }
    skg_volume_source_init(&source);
    ck_skg(skg_material_create_named("Water", &material));
    source.columns = source.rows = source.slices = N;
    source.cells = cells, source.type = SKG_VOLUME_UINT16, source.values = SKG_VOLUME_DENSITY;
    source.material = material;
    for (int k = 0; k < 3; k++) source.affine[5 * k] = 0.25, source.affine[4 * k + 3] = -0.125 * (N - 1);
    for (int volume = 0; volume < 2; volume++) {
        skg_scene *scene = make_scene();
        if (volume) {
            add_volume(scene, &source, -1);
        } else {
            if (_i) ck_skg(skg_mesh_create_cuboid(24, 24, 24, &mesh));
            if (!_i) ck_skg(skg_mesh_create_cylinder(10, 24, 360, &mesh));
            ck_skg(skg_material_retain(material));
            add_mesh(scene, "mesh", mesh, material, middle, -1);
        }
        if (_i) {
            skg_material *metal = NULL;
            ck_skg(skg_material_create_named("Ti", &metal));
            ck_skg(skg_mesh_create_cylinder(4, 14, 60, &mesh));
            add_mesh(scene, "rod", mesh, metal, aside, 0);
        }
        ck_skg(render(context, scene, &options, volume ? image : other));
        skg_scene_release(&scene);
    }
    for (int p = 0; p < PIXELS; p++) sums[0] += image[p], sums[1] += other[p];
    /* The faces of meshes are rounded, as above. */
    if (_i) ck_assert_double_lt(worst_of(image, other), 2e-6);
    /* The cells have 4.6e-4 less area than the circle, and some 30 rays across sample their steps. */
    ck_assert_double_eq_tol(sums[0] / sums[1], 1, _i ? 2e-6 : 3e-3);
    skg_material_release(&material);
}
END_TEST

START_TEST(bits_depend_on_nothing) {
    static const int32_t strategies[3] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    static double first[PIXELS], image[PIXELS];
    static const double aside[3] = {3, 0, -4};
    skg_scene *scene = make_scene();
    skg_volume_source source;
    skg_plan_options options;
    skg_mesh *mesh = NULL;
    skg_material *metal = NULL;
    source_of(&source, numbers, SKG_VOLUME_INT16, SKG_VOLUME_HU);
    add_volume(scene, &source, -1);
    ck_skg(skg_material_create_named("Ti", &metal));
    ck_skg(skg_mesh_create_cylinder(4, 14, 60, &mesh));
    add_mesh(scene, "rod", mesh, metal, aside, 0);
    skg_plan_options_init(&options);
    options.tolerance = 1e-3;
    for (int k = 0; k < 4; k++) {
        skg_context *alone = NULL;
        if (k == 3) ck_skg(skg_context_create("device=cpu threads=1", &alone));
        options.strategy = strategies[k % 3];
        ck_skg(render(alone ? alone : context, scene, &options, k ? image : first));
        if (k) ck_assert_mem_eq(image, first, sizeof first);
        skg_context_release(&alone);
    }
    skg_scene_release(&scene);
}
END_TEST

START_TEST(what_is_not_computed_is_refused) {
    static double image[PIXELS];
    static const double middle[3] = {0, 0, 0};
    skg_scene *scene = make_scene();
    skg_volume_source source;
    skg_plan_options options;
    skg_mesh *mesh = NULL;
    skg_material *water = NULL;
    source_of(&source, numbers, SKG_VOLUME_INT16, SKG_VOLUME_HU);
    add_volume(scene, &source, -1);
    skg_plan_options_init(&options);
    options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(render(context, scene, &options, image), SKG_ERR_UNSUPPORTED, "volumes");
    skg_plan_options_init(&options);
    options.unite = 1;
    ck_skg_fails(render(context, scene, &options, image), SKG_ERR_UNSUPPORTED, "not united");
    skg_part box;
    double corners_of_box[24], moved[24];
    skg_plan *plan = NULL;
    skg_output output;
    skg_part_init(&box);
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_scene_part_get(scene, 0, &box));
    ck_skg(skg_mesh_positions_get(box.mesh, corners_of_box, 3));
    for (int k = 0; k < 24; k++) moved[k] = corners_of_box[k] + 1;
    skg_plan_options_init(&options);
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_image(plan, &output));
    ck_skg(skg_mesh_positions_set(box.mesh, moved, 3));
    ck_skg_fails(skg_plan_image(plan, &output), SKG_ERR_SCENE, "move the part by its pose");
    skg_plan_release(&plan);
    ck_skg(skg_material_create_named("Water", &water));
    ck_skg_fails(skg_scene_part_material_set(scene, 0, water), SKG_ERR_UNSUPPORTED, "whose cells say");
    static const double corners[9] = {0, 0, 0, 5, 0, 0, 0, 5, 0};
    static const int32_t triangle[3] = {0, 1, 2};
    skg_mesh_source open;
    skg_mesh_source_init(&open);
    open.vertices = 3, open.triangles = 1, open.positions = corners, open.corners = triangle;
    ck_skg(skg_mesh_create(context, "leaf", &open, &mesh));
    add_mesh(scene, "leaf", mesh, water, middle, 0);
    skg_plan_options_init(&options);
    ck_skg_fails(render(context, scene, &options, image), SKG_ERR_UNSUPPORTED,
                 "leaf lies inside the volume volume");
    skg_scene_release(&scene);
}
END_TEST

/* Whether the last frame of a plan had the stage of volumes, and the bytes of the plan. */
static int has_stage(skg_scene *scene, int64_t *bytes) {
    static double image[PIXELS];
    int64_t count = 0;
    int found = 0;
    skg_plan *plan = NULL;
    skg_output output;
    skg_plan_report report;
    skg_plan_options options;
    skg_plan_options_init(&options);
    skg_plan_report_init(&report);
    skg_output_init(&output);
    options.profile = 1;
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_image(plan, &output));
    ck_skg(skg_plan_stage_count(plan, &count));
    for (int64_t k = 0; k < count; k++) {
        skg_stage stage;
        skg_stage_init(&stage);
        ck_skg(skg_plan_stage_get(plan, k, &stage));
        found |= strcmp(stage.name, "volume") == 0;
    }
    ck_skg(skg_plan_report_get(plan, &report));
    *bytes = report.device_bytes;
    skg_plan_release(&plan);
    return found;
}

/* Without a volume there is no stage; with one, its cells are on the device once. */
START_TEST(what_is_absent_costs_nothing) {
    enum { N = 64 };
    static uint16_t cells[N * N * N];
    static const double middle[3] = {0, 0, 0};
    int64_t bytes[2];
    skg_scene *scenes[2] = {make_scene(), make_scene()};
    skg_mesh *mesh = NULL;
    skg_material *water = NULL;
    skg_volume_source source;
    ck_skg(skg_mesh_create_cuboid(20, 20, 20, &mesh));
    ck_skg(skg_material_create_named("Water", &water));
    skg_volume_source_init(&source);
    source.columns = source.rows = source.slices = N, source.cells = cells, source.type = SKG_VOLUME_UINT16;
    source.values = SKG_VOLUME_DENSITY, source.material = water;
    for (int k = 0; k < N * N * N; k++) cells[k] = 1;
    add_volume(scenes[1], &source, -1);
    add_mesh(scenes[0], "water", mesh, water, middle, -1);
    ck_assert_int_eq(has_stage(scenes[0], &bytes[0]), 0);
    ck_assert_int_eq(has_stage(scenes[1], &bytes[1]), 1);
    /* Further planes are 40 x 36 accumulators of 8 bytes, at most, and tables of some kB. */
    ck_assert_int_ge(bytes[1] - bytes[0], (int64_t)sizeof cells);
    ck_assert_int_lt(bytes[1] - bytes[0], (int64_t)sizeof cells + 65536);
    for (int k = 0; k < 2; k++) skg_scene_release(&scenes[k]);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, hounsfield_numbers_are_schneiders_tissues);
    tcase_add_loop_test(tests, water_is_water, 0, 2);
    tcase_add_loop_test(tests, cells_stand_for_meshes, 0, 2);
    tcase_add_test(tests, bits_depend_on_nothing);
    tcase_add_test(tests, what_is_absent_costs_nothing);
    tcase_add_test(tests, what_is_not_computed_is_refused);
}

SKG_SUITE_MAIN("volume_matter", add_tests)
