/* Tolerance of -ln(I/I0): the plan states an absolute error, which is compared with that of the image. */
#include "support/named.h"
#include "support/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PIXELS = 64 };

static skg_spectrum *tube(void) {
    skg_tube t;
    skg_spectrum *beam = NULL;
    skg_material *aluminium = named("Al");
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 3};
    skg_tube_init(&t);
    t.kvp = 120, t.filter_count = 1, t.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&t, &beam));
    skg_material_release(&aluminium);
    return beam;
}

/* The image of a plan of its own, and what the plan says of the compression. */
static double *image_of(skg_scene *scene, const skg_view *view, skg_spectrum *beam, double tolerance,
                        char reason[512]) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    int64_t count = 0;
    skg_plan_options_init(&options);
    options.tolerance = tolerance, options.quantity = SKG_QUANTITY_ATTENUATION;
    options.precision = run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    ck_skg(skg_plan_create(run_context, scene, view, beam, &options, &plan));
    ck_skg(skg_plan_effect_count(plan, &count));
    for (int64_t k = 0; k < count; k++) {
        skg_effect effect;
        skg_effect_init(&effect);
        ck_skg(skg_plan_effect_get(plan, k, &effect));
        if (!strcmp(effect.name, "spectral compression")) snprintf(reason, 512, "%s", effect.reason);
    }
    double *image = run_image(plan, view);
    skg_plan_release(&plan);
    return image;
}

/* 150 mm of iron pass 1e-16: errors are relative to 1e-6 there, so that the logarithm is off by far more than the tolerance. */
START_TEST(the_plan_states_the_error_of_the_logarithm) {
    const skg_view view = run_view(PIXELS, 2);
    char reason[512] = "", none[512] = "";
    double stated = 0, least = 0, worst = 0, most = 0;
    skg_scene *scene = NULL;
    skg_mesh *mesh = NULL;
    skg_part part;
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_cuboid(300, 300, _i ? 150 : 10, &mesh));
    skg_part_init(&part);
    part.label = "slab", part.mesh = mesh, part.material = named("Fe");
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&mesh);
    skg_material_release(&part.material);
    skg_spectrum *beam = tube();
    double *got = image_of(scene, &view, beam, 1e-3, reason);
    double *truth = image_of(scene, &view, beam, 0, none);
    ck_assert_ptr_null(strstr(none, "-ln"));
    const char *at = strstr(reason, "of -ln(I/I0)");
    ck_assert_msg(at != NULL, "%s", reason);
    ck_assert_int_eq(sscanf(at, "of -ln(I/I0) %lf, at transmissions down to %lf", &stated, &least), 2);
    for (int64_t p = 0; p < PIXELS * PIXELS; p++)
        worst = fmax(worst, fabs(got[p] - truth[p])), most = fmax(most, truth[p]);
    /* Two digits, and pixels lie a little beyond the rays that were traced. */
    ck_assert_double_eq_tol(-log(least), most, 0.1 + 0.005 * most);
    ck_assert_msg(worst <= 1.1 * stated + 1e-6 && worst >= 0.5 * stated - 1e-6, "%g of stated %g", worst,
                  stated);
    if (_i)
        ck_assert_double_gt(stated, 1e-3);
    else
        ck_assert_double_le(stated, 1.01e-3); /* the tolerance, to two digits */
    free(got);
    free(truth);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, the_plan_states_the_error_of_the_logarithm, 0, 2);
}

SKG_SUITE_MAIN("logarithm", add_tests)
