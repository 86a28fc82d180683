/* Effects without a cost in a frame are arguments of a program and not programs: jaws, whether they stop rays or not. */
#include "core/context.h"
#include "device/device.h"
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <string.h>

enum { SIDE = 24 };

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *beam;
static skg_view view;
static float without[SIDE * SIDE], image[SIDE * SIDE];

static void open_scene(void) {
    skg_part part;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cuboid(10, 20, 30, &part.mesh));
    ck_skg(skg_material_create_mu("wax", 0.3, &part.material));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -500, view.centre[2] = 100;
    view.column_step[0] = view.row_step[1] = 1;
}

static void close_scene(void) {
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

/* Renders an image. Returns how many programs were compiled or loaded for it. */
static int programs_of(const skg_collimation *collimation, float *pixels) {
    const skg_device *device = context->device;
    const int before = (int)(device->builds + device->loads);
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output output;
    skg_plan_options_init(&options);
    options.collimation = collimation;
    skg_output_init(&output);
    output.data = pixels;
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
    return (int)(device->builds + device->loads) - before;
}

START_TEST(jaws_have_no_program) {
    skg_collimation jaws;
    skg_collimation_init(&jaws);
    /* The first context tests the device, whose verdict is then known. */
    jaws.kind = SKG_COLLIMATION_DETECTOR, jaws.margin_mm = -3.2;
    programs_of(&jaws, image);
    close_scene();
    open_scene();
    skg_collimation_init(&jaws);
    programs_of(NULL, without);
    ck_assert_int_eq(programs_of(&jaws, image), 0);
    ck_assert_int_eq(memcmp(image, without, sizeof image), 0);
    jaws.kind = SKG_COLLIMATION_DETECTOR;
    ck_assert_int_eq(programs_of(&jaws, image), 0);
    ck_assert_int_eq(memcmp(image, without, sizeof image), 0);
    jaws.margin_mm = -3.2;
    ck_assert_int_eq(programs_of(&jaws, image), 0);
    ck_assert_int_ne(memcmp(image, without, sizeof image), 0);
    ck_assert_int_eq(programs_of(NULL, image), 0);
    ck_assert_int_eq(memcmp(image, without, sizeof image), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, jaws_have_no_program);
}

SKG_SUITE_MAIN("absent", add_tests)
