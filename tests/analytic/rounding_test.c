/* The bound of the precision: single against double, and what it should be in closed form. */
#include "support/named.h"
#include "support/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = 128 };

/* Transmissions of a plan of its own. */
static double *transmissions(skg_scene *scene, const skg_view *view, skg_spectrum *beam, int32_t precision,
                             double *bound) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    options.precision = precision, options.overlaps = 0;
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    ck_skg(skg_plan_create(run_context, scene, view, beam, &options, &plan));
    ck_skg(skg_plan_precision_bound_get(plan, bound));
    double *image = run_image(plan, view);
    skg_plan_release(&plan);
    return image;
}

static void add(skg_scene *scene, const char *label, solid shape, const char *material, const double *pose,
                int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    part.label = label, part.inside = inside;
    part.mesh = run_mesh(&shape), part.material = named(material);
    if (pose) memcpy(part.pose, pose, sizeof part.pose);
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    solid_free(&shape);
}

static skg_spectrum *tube(double kvp) {
    skg_tube t;
    skg_spectrum *beam = NULL;
    skg_material *aluminium = named("Al");
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 3};
    skg_tube_init(&t);
    t.kvp = kvp, t.filter_count = 1, t.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&t, &beam));
    skg_material_release(&aluminium);
    return beam;
}

/* A body of 24 cm with bones, smooth, so that no face lies along a ray but at silhouettes, where lengths are short. */
static skg_scene *body(void) {
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    const double left[16] = {1, 0, 0, -40, 0, 1, 0, 13, 0, 0, 1, 20, 0, 0, 0, 1};
    const double right[16] = {1, 0, 0, 35, 0, 1, 0, -21, 0, 0, 1, -30, 0, 0, 0, 1};
    add(scene, "body", solid_sphere(120, 64, 32), "Tissue, Soft (ICRU-44)", NULL, -1);
    add(scene, "bone", solid_blob(30, 40, 20, 7), "Bone, Cortical (ICRU-44)", left, 0);
    add(scene, "lung", solid_sphere(45, 40, 20), "Lung Tissue (ICRU-44)", right, 0);
    return scene;
}

START_TEST(single_stays_within_the_bound_of_double) {
    if (!run_has_double()) skip_test("the device has no fp64");
    const skg_view view = run_view(PIXELS, 2.5);
    skg_scene *scene = body();
    skg_spectrum *beam = tube(_i ? 120 : 60);
    double single = 0, twice = 0, worst = 0;
    double *got = transmissions(scene, &view, beam, SKG_PRECISION_SINGLE, &single);
    double *truth = transmissions(scene, &view, beam, SKG_PRECISION_DOUBLE, &twice);
    for (int64_t p = 0; p < PIXELS * PIXELS; p++)
        worst = fmax(worst, fabs(got[p] - truth[p]) / fmax(truth[p], 1e-6));
    /* The images are floats: half of 2^-23 each. */
    ck_assert_double_le(worst, single + 0x1p-23);
    /* Not a bound that says nothing: body, bone and lung at 3e-5 of exponents of 2 to 6 in all. */
    ck_assert_double_lt(single, 1e-3);
    ck_assert_double_gt(single, worst / 2);
    ck_assert_double_lt(twice, 1e-9); /* 1e-11 of the same exponents */
    free(got);
    free(truth);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}
END_TEST

/* One slab, one energy: the share of the longest path times its exponent, with the margin of a quarter. */
START_TEST(a_slab_has_the_bound_of_its_exponent) {
    const skg_view view = run_view(PIXELS, 1);
    double bound = 0;
    skg_scene *scene = NULL;
    skg_spectrum *beam = NULL;
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_mesh *mesh = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_cuboid(400, 400, 100, &mesh));
    run_part(scene, "slab", mesh, 0.2, NULL, -1);
    skg_mesh_release(&mesh);
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    skg_plan_options_init(&options);
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_precision_bound_get(plan, &bound));
    skg_plan_release(&plan);
    /* Rays to the corners are 0.3 % longer; exponentials add 1e-6, and exponents of 2 some 1e-7 of themselves. */
    ck_assert_double_eq_tol(bound, 1.25 * 3e-5 * 2, 0.004 * 7.5e-5 + 1.5e-6);
    options.precision = SKG_PRECISION_HALF;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_precision_bound_get(plan, &bound));
    /* Two faces at 1.1 m of 1.2 m, each by half of 2^-10 m: 0.98 mm of 0.2 per cm. 2^-11 for the image of 16 bits, and what
     * single precision and the steep end of the exponential add: 1 % of it. */
    ck_assert_double_eq_tol(bound, 0.0195 + 0x1p-11, 0.03 * 0.0195);
    ck_skg_fails(skg_plan_precision_bound_get(NULL, &bound), SKG_ERR_ARGUMENT, "plan");
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}
END_TEST

/* A foil of .02: intensities are off by 1e-6 for the exponential and 1.25 * 3e-5 of the exponent, its attenuation by fifty times that
 * share of itself. */
START_TEST(a_foil_has_a_bound_of_its_attenuation) {
    const skg_view view = run_view(PIXELS, 1);
    const double of_intensity = 1e-6 + 1.25 * 3e-5 * 0.02;
    skg_scene *scene = NULL;
    skg_mesh *mesh = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_cuboid(400, 400, 1, &mesh));
    run_part(scene, "foil", mesh, 0.2, NULL, -1);
    skg_mesh_release(&mesh);
    const int32_t quantities[] = {SKG_QUANTITY_TRANSMISSION, SKG_QUANTITY_ATTENUATION};
    for (int k = 0; k < 2; k++) {
        double bound = 0, expected = k == 0 ? of_intensity : of_intensity / 0.02;
        skg_plan *plan = run_plan(scene, &view, (run_choice){.quantity = quantities[k]});
        ck_skg(skg_plan_precision_bound_get(plan, &bound));
        ck_assert_double_eq_tol(bound, expected, 0.01 * expected); /* rays to the corners: .3 % */
        skg_plan_release(&plan);
    }
    skg_scene_release(&scene);
}
END_TEST

/* A pixel that detects no photon has the attenuation that the header names. */
START_TEST(no_photons_are_126_doublings) {
    const skg_view view = run_view(PIXELS, 1);
    skg_scene *scene = NULL;
    skg_spectrum *beam = NULL;
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_mesh *mesh = NULL;
    int64_t empty = 0;
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_cuboid(400, 400, 100, &mesh));
    run_part(scene, "slab", mesh, 0.5, NULL, -1);
    skg_mesh_release(&mesh);
    ck_skg(skg_spectrum_create_mono(60, 50, &beam)); /* 0.3 photons in a pixel */
    skg_plan_options_init(&options);
    options.noise = 1, options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    double *image = run_image(plan, &view);
    for (int64_t p = 0; p < PIXELS * PIXELS; p++) {
        ck_assert(isfinite(image[p]));
        if (image[p] < 10) continue;
        ck_assert_double_eq_tol(image[p], 126 * log(2),
                                87 * 4 * 0x1p-24); /* a float, and the logarithm's error */
        empty++;
    }
    ck_assert_int_gt(empty, PIXELS * PIXELS / 2);
    free(image);
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}
END_TEST

static char warning[512];

static void keep_warning(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING) snprintf(warning, sizeof warning, "%s", sentence);
}

/* A plate of lead of 120 x 80 mm, turned by 45 degrees. */
static skg_scene *leaning_plate(double thickness) {
    static const double c = 0.7071067811865476;
    const double pose[16] = {1, 0, 0, 0, 0, c, -c, 0, 0, c, c, 0, 0, 0, 0, 1};
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    add(scene, "foil", solid_box(120, 80, thickness), "Pb", pose, -1);
    return scene;
}

/* Extents of 57 mm along the rays: 2e-6 of it are 0.11 um, above 1 % of the path of 7 um of a foil of 5 um, and below that of
 * 70 um of a plate of 50 um. */
START_TEST(a_plan_names_double_for_thin_parts) {
    const skg_view view = run_view(PIXELS, 1);
    skg_spectrum *beam = NULL;
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    ck_skg(skg_context_log_set(run_context, keep_warning, NULL));
    for (int k = 0; k < 3; k++) {
        double bound = 0;
        skg_scene *scene = leaning_plate(k == 1 ? 0.05 : 0.005);
        *warning = '\0';
        if (k == 2 && !run_has_double()) break;
        free(transmissions(scene, &view, beam, k == 2 ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE, &bound));
        if (k == 0)
            ck_assert_msg(strstr(warning, "part foil") && strstr(warning, "take precision double"), "%s",
                          warning);
        else
            ck_assert_msg(!*warning, "%s", warning);
        skg_scene_release(&scene);
    }
    skg_spectrum_release(&beam);
}
END_TEST

/* The number that the warning states against the error, for 1 mm to 40 mm of matter. */
START_TEST(half_warns_with_a_number_that_holds) {
    static const double thickness[] = {1, 5, 40}, mu[] = {5, 1, 0.3};
    const skg_view view = run_view(PIXELS, 1);
    skg_spectrum *beam = NULL;
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    ck_skg(skg_context_log_set(run_context, keep_warning, NULL));
    for (int k = 0; k < 3; k++) {
        double single, half, worst = 0, stated = 0;
        skg_mesh *mesh = NULL;
        skg_scene *scene = NULL;
        ck_skg(skg_scene_create(run_context, &scene));
        ck_skg(skg_mesh_create_cuboid(100, 100, thickness[k], &mesh));
        run_part(scene, "slab", mesh, mu[k], NULL, -1);
        skg_mesh_release(&mesh);
        double *truth = transmissions(scene, &view, beam, SKG_PRECISION_SINGLE, &single);
        *warning = '\0';
        double *got = transmissions(scene, &view, beam, SKG_PRECISION_HALF, &half);
        for (int64_t p = 0; p < PIXELS * PIXELS; p++) {
            /* Rays at the rim of the slab are cut by the side that a last place decides. */
            const int64_t column = p % PIXELS - PIXELS / 2, row = p / PIXELS - PIXELS / 2;
            if (labs((long)column) > 40 || labs((long)row) > 40) continue;
            worst = fmax(worst, fabs(got[p] - truth[p]) / truth[p]);
        }
        ck_assert_int_eq(
            sscanf(warning, "precision half: intensities of this scene may be wrong by %lf %%", &stated), 1);
        ck_assert_double_eq_tol(stated, 100 * half, 6 * half); /* two digits */
        ck_assert_double_le(worst, half);
        ck_assert_double_gt(worst,
                            half / 10); /* not a bound that says nothing: both faces seldom err by the most */
        free(got);
        free(truth);
        skg_scene_release(&scene);
    }
    skg_spectrum_release(&beam);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, single_stays_within_the_bound_of_double, 0, 2);
    tcase_add_test(tests, a_slab_has_the_bound_of_its_exponent);
    tcase_add_test(tests, a_foil_has_a_bound_of_its_attenuation);
    tcase_add_test(tests, a_plan_names_double_for_thin_parts);
    tcase_add_test(tests, half_warns_with_a_number_that_holds);
    tcase_add_test(tests, no_photons_are_126_doublings);
}

SKG_SUITE_MAIN("rounding", add_tests)
