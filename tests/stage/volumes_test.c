/* Volumes on devices with vectors of other widths, and on one that is too small. */
#include "device/device.h"
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 37, PIXELS = SIDE * SIDE, N = 9, CELLS = N * N * N };

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *beam;
static skg_view view;

static void open_context(void) {
    static int16_t cells[CELLS];
    static const double kev[2] = {50, 80}, photons[2] = {3, 2};
    skg_volume_source source;
    skg_part part;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &beam));
    for (int k = 0; k < CELLS; k++) cells[k] = (int16_t)(k * 7919 % 1500 - 500);
    skg_volume_source_init(&source);
    source.columns = source.rows = source.slices = N, source.cells = cells;
    /* The first axis is oblique, so that rays beside each other have slices along two axes. */
    source.affine[0] = 5, source.affine[4] = 3.4, source.affine[5] = 6, source.affine[10] = 5.5;
    source.affine[3] = -20, source.affine[7] = -38, source.affine[11] = -22;
    skg_part_init(&part);
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = "volume";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
    skg_part_init(&part);
    ck_skg(skg_mesh_create_sphere(9, 20, &part.mesh));
    ck_skg(skg_material_create_named("Ti", &part.material));
    part.label = "ball", part.inside = 0;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = -120, view.source[1] = -10, view.source[2] = -105;
    view.centre[0] = 60, view.centre[2] = 60;
    view.column_step[0] = -2.5, view.column_step[2] = 2.5;
    view.row_step[1] = 3.1;
}

static void close_context(void) {
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

static skg_status render(float *image) {
    skg_plan *plan = NULL;
    skg_output output;
    skg_output_init(&output);
    output.data = image;
    const skg_status status = skg_plan_create(context, scene, &view, beam, NULL, &plan);
    if (status != SKG_OK) return status;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
    return SKG_OK;
}

START_TEST(bits_do_not_depend_on_vectors) {
    static float first[PIXELS], image[PIXELS];
    /* The last for ./check --full: the images of other tests have the width of the device, 8 or 16. */
    static const int32_t widths[4] = {16, 1, 1, 8};
    const int turns = suite_turns(4, 3);
    for (int k = 0; k < turns; k++) {
        context->device->info.float_width = widths[k];
        context->device->info.gpu = k == 2;
        ck_skg(render(k ? image : first));
        if (k)
            ck_assert_msg(memcmp(image, first, sizeof first) == 0, "width %d, gpu %d", (int)widths[k],
                          k == 2);
    }
    ck_assert_int_ne(memcmp(first, first + SIDE, SIDE * sizeof *first), 0);
}
END_TEST

START_TEST(a_small_device_is_named) {
    static float image[PIXELS];
    context->device->info.max_allocation = CELLS;
    ck_skg_fails(render(image), SKG_ERR_DEVICE_MEMORY, "crop the volume");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, bits_do_not_depend_on_vectors);
    tcase_add_test(tests, a_small_device_is_named);
}

SKG_SUITE_MAIN("volumes", add_tests)
