/* Precision half reproduces what the paper's 16-bit buffers gave for its object (Vidal and Villard
 * 2016, 4.3.2): 29.831 and 4355.469 keV, which are 1955 * 2^-16 and 1115 * 2^-8 MeV. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 65 };

/* A cube of soft tissue of 3 cm with a cylinder of bone of 2 cm across (20 sectors) in it, at coefficients in
 * 1/cm of each energy. */
static void add(skg_scene *scene, skg_mesh *mesh, skg_material *material, int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    part.mesh = mesh, part.material = material, part.inside = inside;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&mesh);
    skg_material_release(&material);
}

static skg_scene *paper_object(skg_context *context) {
    /* The paper's tables 3 and 4. */
    static const double kev[4] = {80, 100, 200, 300}, bone[4] = {.3971, .3328, .2369, .2018};
    static const double soft[4] = {.1937, .1800, .1445, .1251};
    skg_scene *scene = NULL;
    skg_mesh *cube = NULL, *rod = NULL;
    skg_material *outer = NULL, *inner = NULL;
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_mesh_create_cube(30, &cube));
    ck_skg(skg_mesh_create_cylinder(10, 30, 20, &rod));
    ck_skg(skg_material_create_table("soft tissue", 4, kev, soft, &outer));
    ck_skg(skg_material_create_table("bone", 4, kev, bone, &inner));
    add(scene, cube, outer, -1);
    add(scene, rod, inner, 0);
    return scene;
}

/* The middle pixel in keV; the source at 10 cm. */
static double middle(skg_context *context, skg_scene *scene, skg_spectrum *beam, int32_t precision) {
    static float image[SIDE * SIDE];
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_output output;
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = -100; /* the cylinder stands along z */
    view.centre[0] = 100;
    view.column_step[1] = view.row_step[2] = 0.3;
    skg_plan_options_init(&options);
    options.precision = precision;
    skg_output_init(&output);
    output.data = image;
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
    return (double)image[SIDE * SIDE / 2];
}

START_TEST(printed_values) {
    static const double kev[3] = {100, 200, 300}, photons[3] = {10, 20, 10};
    skg_context *context = NULL;
    skg_spectrum *one = NULL, *three = NULL;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_spectrum_create_mono(80, 1, &one));
    ck_skg(skg_spectrum_create_bins(3, kev, photons, &three));
    skg_scene *scene = paper_object(context);
    /* exactly: a value of 16 bits, in keV as float */
    ck_assert_double_eq_tol(middle(context, scene, one, SKG_PRECISION_HALF), ldexp(1955, -16) * 1000, 1e-5);
    ck_assert_double_eq_tol(middle(context, scene, three, SKG_PRECISION_HALF), ldexp(1115, -8) * 1000, 1e-3);
    /* single: the closed form of the printed coefficients, 2 cm of bone and 1 cm of tissue */
    const double truth = 80 * exp(-2 * .3971 - .1937);
    ck_assert_double_eq_tol(middle(context, scene, one, SKG_PRECISION_SINGLE), truth, 1e-6 * truth);
    skg_scene_release(&scene);
    skg_spectrum_release(&one);
    skg_spectrum_release(&three);
    skg_context_release(&context);
}
END_TEST

START_TEST(what_half_cannot_hold_is_refused) {
    skg_context *context = NULL;
    skg_spectrum *one = NULL;
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_view view;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_spectrum_create_mono(80, 1, &one));
    skg_scene *scene = paper_object(context);
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.projection = SKG_PROJECTION_PARALLEL;
    view.source[2] = -100;
    view.centre[2] = 100;
    view.column_step[0] = view.row_step[1] = 0.3;
    skg_plan_options_init(&options);
    options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(context, scene, &view, one, &options, &plan), SKG_ERR_UNSUPPORTED, "half");
    skg_scene_release(&scene);
    skg_spectrum_release(&one);
    skg_context_release(&context);
}
END_TEST

static int warned;

static void count_warning(int32_t level, const char *sentence, void *user) {
    (void)user;
    warned += level == SKG_LOG_WARNING && strstr(sentence, "precision single") != NULL;
}

/* 80 keV by a million photons are 80,000 MeV: infinite in 16 bits where nothing attenuates them. */
START_TEST(overflow_is_reported) {
    static float image[SIDE * SIDE];
    skg_context *context = NULL;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_plan_report report;
    skg_output output;
    skg_view view;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_context_log_set(context, count_warning, NULL));
    ck_skg(skg_spectrum_create_mono(80, 1e6, &beam));
    skg_scene *scene = paper_object(context);
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = -100;
    view.centre[0] = 100;
    view.column_step[1] = view.row_step[2] = 2;
    skg_plan_options_init(&options);
    skg_plan_report_init(&report);
    skg_output_init(&output);
    output.data = image;
    for (int half = 1; half >= 0; half--) {
        int64_t infinite = 0;
        options.precision = half ? SKG_PRECISION_HALF : SKG_PRECISION_SINGLE;
        ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
        if (half)
            ck_skg_fails(skg_plan_image(plan, &output), SKG_RANGE, "precision single");
        else
            ck_skg(skg_plan_image(plan, &output));
        for (int p = 0; p < SIDE * SIDE; p++) infinite += !isfinite(image[p]);
        ck_skg(skg_plan_report_get(plan, &report));
        ck_assert_int_eq(report.infinite_pixels, infinite);
        ck_assert_int_eq(infinite > 0, half);
        skg_plan_release(&plan);
    }
    ck_assert_int_eq(warned, 1);
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, overflow_is_reported);
    tcase_add_test(tests, printed_values);
    tcase_add_test(tests, what_half_cannot_hold_is_refused);
}

SKG_SUITE_MAIN("half", add_tests)
