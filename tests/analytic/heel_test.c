/* The heel effect against spectra of the tube at the angle of each ray, made one by one. */
#include "support/angles.h"
#include "support/named.h"
#include "support/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = 24 };

/* The logarithm of what is transmitted is held to this for the whole beam (lib/spectral/shades.c takes directions until 2e-4
 * is left; where it is worst, twice that is allowed). */
static const double BAR = 4e-4;

static skg_material *aluminium, *water;
static skg_scene *scene;
static skg_heel heel;
static skg_view view;

static void open_scene(void) {
    skg_mesh *slab = NULL;
    skg_part part;
    run_open();
    aluminium = named("Al"), water = named("water");
    ck_skg(skg_mesh_create_cuboid(1000, 1000, 50, &slab));
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    part.mesh = slab, part.material = water, part.label = "slab";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&slab);
    skg_heel_init(&heel);
    heel.kvp = 90, heel.angle_deg = 14;
    heel.direction[0] = 1;
    view = run_view(PIXELS, 10); /* 240 mm at 1200 mm: 14 degrees +- 5.5 */
}

static void close_scene(void) {
    skg_scene_release(&scene);
    skg_material_release(&aluminium);
    skg_material_release(&water);
    run_close();
}

static skg_spectrum *tube(double angle) {
    skg_tube t;
    skg_spectrum *beam = NULL;
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 2.5};
    skg_tube_init(&t);
    t.kvp = heel.kvp, t.angle_deg = angle, t.filter_count = 1, t.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&t, &beam));
    return beam;
}

static void pixel_of(const skg_view *v, int64_t p, double ray[3]) {
    const double c = (double)(p % PIXELS) - (PIXELS - 1) / 2.0, r = (double)(p / PIXELS) - (PIXELS - 1) / 2.0;
    for (int k = 0; k < 3; k++)
        ray[k] = v->centre[k] + c * v->column_step[k] + r * v->row_step[k] - v->source[k];
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The angle to the anode's face, in degrees: the face holds the direction that leans from the central ray towards the anode
 * by the anode's angle, and what is perpendicular to both. */
static double angle_of(const skg_view *v, const double *toward, int64_t p) {
    double central[3], ray[3], across[3], length = 0;
    for (int k = 0; k < 3; k++) central[k] = v->centre[k] - v->source[k];
    const double along = dot(toward, central) / dot(central, central);
    for (int k = 0; k < 3; k++) across[k] = toward[k] - along * central[k];
    length = sqrt(dot(across, across));
    pixel_of(v, p, ray);
    const double theta = heel.angle_deg * degree;
    const double sine = (sin(theta) * dot(ray, central) / sqrt(dot(central, central)) -
                         cos(theta) * dot(ray, across) / length) /
                        sqrt(dot(ray, ray));
    return asin(sine) / degree;
}

/* keV or photons per pixel behind mm of water. */
static double expected(double angle, double mm, int photons) {
    skg_spectrum *beam = tube(angle);
    double sum = 0;
    int64_t count = 0;
    ck_skg(skg_spectrum_bin_count(beam, &count));
    for (int64_t i = 0; i < count; i++) {
        double kev = 0, number = 0, per_cm = 0;
        ck_skg(skg_spectrum_bin_get(beam, i, &kev, &number));
        ck_skg(skg_material_attenuation_get(water, kev, &per_cm));
        sum += number * (photons ? 1 : kev) * exp(-per_cm * mm / 10);
    }
    skg_spectrum_release(&beam);
    return sum;
}

/* The way of a ray through the slab, which lies across z and is 50 mm thick. */
static double way_of(const skg_view *v, int64_t p) {
    double ray[3];
    pixel_of(v, p, ray);
    return 50 * sqrt(dot(ray, ray)) / fabs(ray[2]);
}

static double *image(const skg_view *of, const skg_plan_options *options) {
    skg_plan *plan = NULL;
    skg_spectrum *beam = tube(heel.angle_deg);
    ck_skg(skg_plan_create(run_context, scene, &view, beam, options, &plan));
    if (of != &view) ck_skg(skg_plan_view_set(plan, of));
    double *pixels = run_image(plan, of);
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    return pixels;
}

static skg_plan_options heeled(void) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.heel = &heel;
    return options;
}

static void check(const skg_view *v, const double *toward, const skg_plan_options *options, double bar) {
    double *pixels = image(v, options), low = HUGE_VAL, high = 0;
    const int photons = options->quantity == SKG_QUANTITY_PHOTONS;
    for (int64_t p = 0; p < PIXELS * PIXELS; p += 7) { /* some of every row and column */
        const double angle = angle_of(v, toward, p), mm = way_of(v, p);
        double truth = expected(angle, mm, photons);
        if (options->quantity == SKG_QUANTITY_TRANSMISSION) truth /= expected(angle, 0, 0);
        if (options->quantity == SKG_QUANTITY_ATTENUATION) truth = -log(truth / expected(angle, 0, 0));
        const double error =
            options->quantity == SKG_QUANTITY_ATTENUATION ? pixels[p] - truth : pixels[p] / truth - 1;
        ck_assert_msg(fabs(error) <= bar, "pixel %d at %g degrees: %g instead of %g", (int)p, angle,
                      pixels[p], truth);
        low = fmin(low, pixels[p]), high = fmax(high, pixels[p]);
    }
    /* The effect is large: from side to side the beam changes by more than a twentieth. */
    if (options->quantity <= SKG_QUANTITY_PHOTONS) ck_assert_double_gt(high / low, 1.05);
    free(pixels);
}

START_TEST(every_ray_has_its_spectrum) {
    skg_plan_options options = heeled();
    check(&view, heel.direction, &options, BAR);
    options.quantity = SKG_QUANTITY_PHOTONS;
    check(&view, heel.direction, &options, BAR);
    heel.direction[0] = 0.6, heel.direction[1] = -0.8, heel.direction[2] = 5; /* the last does not count */
    check(&view, heel.direction, &options, BAR);
    if (run_has_double()) {
        options.precision = SKG_PRECISION_DOUBLE;
        check(&view, heel.direction, &options, BAR);
    }
}
END_TEST

/* Fewer energies: shades are planes, so the tolerance holds with them. */
START_TEST(compressed_beams_have_heels) {
    skg_plan_options options = heeled();
    options.tolerance = 1e-4;
    check(&view, heel.direction, &options, BAR + options.tolerance);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check(&view, heel.direction, &options, BAR + options.tolerance);
}
END_TEST

/* A ratio is to the flat field of the same pixel. */
START_TEST(ratios_are_to_the_shaded_beam) {
    skg_plan_options options = heeled();
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check(&view, heel.direction, &options, BAR);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    check(&view, heel.direction, &options, BAR);
    options.world = named("Air");
    double *pixels = image(&view, &options);
    skg_material_release(&options.world);
    double *vacuum = image(&view, &options);
    for (int64_t p = 0; p < PIXELS * PIXELS; p++) /* 1.2 m of air harden the beam a little: 0.02 of 1 */
        ck_assert_double_eq_tol(pixels[p], vacuum[p], 0.02);
    free(pixels);
    free(vacuum);
}
END_TEST

/* The direction turns with the detector; columns and rows need not be perpendicular. */
START_TEST(other_views) {
    const double c = cos(25 * degree), s = sin(25 * degree);
    skg_view turned = view;
    skg_plan_options options = heeled();
    double *vectors[] = {turned.source, turned.centre, turned.column_step, turned.row_step};
    double toward[3] = {c, s, 0};
    for (int k = 0; k < 4; k++) { /* about z, along which the slab lies */
        const double x = vectors[k][0], y = vectors[k][1];
        vectors[k][0] = c * x - s * y, vectors[k][1] = s * x + c * y;
    }
    check(&turned, toward, &options, BAR);
    view.row_step[0] = 4, view.centre[0] = 30;
    check(&view, heel.direction, &options, BAR);
}
END_TEST

START_TEST(absent_or_refused) {
    skg_plan_options options = heeled();
    skg_plan *plan = NULL;
    skg_spectrum *beam = tube(14), *mono = NULL;
    skg_view parallel = view;
    ck_skg(skg_spectrum_create_mono(60, 1, &mono));
    options.quantity = SKG_QUANTITY_TRANSMISSION; /* of one energy: the heel cancels */
    ck_skg(skg_plan_create(run_context, scene, &view, mono, &options, &plan));
    skg_plan_release(&plan);
    options.quantity = SKG_QUANTITY_ENERGY;
    parallel.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_plan_create(run_context, scene, &parallel, beam, &options, &plan));
    double *heeled_image = run_image(plan, &parallel);
    skg_plan_release(&plan);
    options.heel = NULL;
    ck_skg(skg_plan_create(run_context, scene, &parallel, beam, &options, &plan));
    double *plain = run_image(plan, &parallel);
    skg_plan_release(&plan);
    ck_assert_mem_eq(heeled_image, plain, PIXELS * PIXELS * sizeof *plain);
    free(plain);
    free(heeled_image);
    options.heel = &heel;
    heel.direction[0] = 0;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "no direction");
    heel.direction[2] = 1;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "along the central ray");
    heel.direction[0] = 1, heel.angle_deg = 5;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_BEAM,
                 "along its face");
    heel.angle_deg = 14, heel.kvp = 80;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_BEAM,
                 "the tube voltage is 80 kV");
    heel.kvp = 0;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_BEAM,
                 "tube voltage of 0 kV");
    heel.kvp = 90, options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "heel");
    skg_spectrum_release(&beam);
    skg_spectrum_release(&mono);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, every_ray_has_its_spectrum);
    tcase_add_test(tests, compressed_beams_have_heels);
    tcase_add_test(tests, ratios_are_to_the_shaded_beam);
    tcase_add_test(tests, other_views);
    tcase_add_test(tests, absent_or_refused);
}

SKG_SUITE_MAIN("heel", add_tests)
