/* Bow-tie filter and anti-scatter grid against sums over the energies, ray by ray. */
#include "in_beam.h"

/* --- the bow-tie --- */

enum { ROWS = 7 };
static const double angles[ROWS] = {-32, -20, -9, -1.5, 3, 14, 32}, paths[ROWS] = {25, 18, 6, 1, 2, 9, 27};
static skg_bowtie bowtie;
static double toward[3]; /* in which its angles grow */

static void make_bowtie(void) {
    skg_bowtie_init(&bowtie);
    bowtie.material = aluminium, bowtie.count = ROWS, bowtie.angle_deg = angles, bowtie.path_mm = paths;
    options.bowtie = &bowtie;
    toward[0] = 1, toward[1] = toward[2] = 0;
}

/* mm of the filter along the ray to pixel p: the profile, linear in the tangent, and 1 / cos of the angle to the fan. */
static double filter_of(const skg_view *v, int64_t p) {
    double ray[3], central[3], across[3], normal[3];
    ray_of(v, p, ray);
    for (int k = 0; k < 3; k++) central[k] = v->centre[k] - v->source[k];
    cross(central, toward, normal); /* of the fan's plane */
    cross(normal, central, across);
    const double tangent = dot(ray, across) / length(across) / (dot(ray, central) / length(central));
    const double lift = asin(fabs(dot(ray, normal)) / length(normal) / length(ray));
    int k = 0;
    while (k < ROWS - 2 && tangent > tan(angles[k + 1] * degree)) k++;
    const double a = tan(angles[k] * degree), b = tan(angles[k + 1] * degree);
    return (paths[k] + (paths[k + 1] - paths[k]) * (tangent - a) / (b - a)) / cos(lift);
}

static double through_filter(const skg_view *v, int64_t p, double energy) {
    return exp(-mu(aluminium, energy) * filter_of(v, p));
}

START_TEST(bowtie_along_every_ray) {
    skg_view other = view;
    make_bowtie();
    ck_assert_double_gt(check(&view, through_filter, SINGLE), 1.2);
    toward[0] = bowtie.direction[0] = 0.6, toward[1] = bowtie.direction[1] = -0.8, bowtie.direction[2] = 3;
    check(&view, through_filter, SINGLE); /* what lies along the central ray does not count */
    bowtie.direction[0] = bowtie.direction[1] = bowtie.direction[2] = 0;
    other.source[0] = 60, other.centre[1] = -40; /* the central ray is not the detector's normal */
    toward[0] = 1, toward[1] = 0;
    check(&other, through_filter, SINGLE);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check(&view, through_filter, SINGLE);
    options.tolerance = 1e-4;
    check(&view, through_filter, SINGLE + options.tolerance);
    options.quantity = SKG_QUANTITY_ENERGY;
    check(&view, through_filter, SINGLE + options.tolerance);
    ck_assert(effect_is_on(&view, beam, "bow-tie filter", "of Al, 7 rows"));
}
END_TEST

/* A blurred ratio is that of the blurred image to the blurred flat field, of one energy and of many. An edge of water is where the blur of the
 * ratio would be another: by .02 of the logarithm with this bow-tie and this blur. */
static void slab_to(double x) {
    const double pose[16] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    ck_skg(skg_scene_part_pose_set(scene, 0, pose));
}

START_TEST(blurred_ratios) {
    static const double along[] = {0.02, 0.03, 0.05, 0.1, 0.6, 0.1, 0.05, 0.03, 0.02};
    skg_spectrum *beams[] = {mono, beam};
    skg_detector_blur blur;
    skg_detector_blur_init(&blur);
    blur.columns = blur.rows = 9, blur.along_row = blur.along_column = along;
    make_bowtie();
    options.blur = &blur;
    for (int b = 0; b < 2; b++)
        for (int falls = 0; falls < 2; falls++) {
            double *images[3];
            options.falloff = falls ? SKG_FALLOFF_ON : SKG_FALLOFF_OFF;
            for (int i = 0; i < 3; i++) { /* the edge of the slab, the open beam, the ratio */
                slab_to(i == 1 ? 1e5 : 1000);
                options.quantity = i == 2 ? SKG_QUANTITY_ATTENUATION : SKG_QUANTITY_ENERGY;
                images[i] = image_of(&view, beams[b]);
            }
            for (int64_t p = 0; p < PIXELS * PIXELS;
                 p++) /* rounding of floats, and the shades of three images */
                ck_assert_double_eq_tol(images[2][p], -log(images[0][p] / images[1][p]), 2e-5);
            for (int i = 0; i < 3; i++) free(images[i]);
        }
    slab_to(0);
}
END_TEST

/* A plate across the beam, leaning by 10 degrees in the fan, is 4 / cos(angle - 10 degrees) mm thick. As a part of the scene it is
 * traced as every mesh. */
START_TEST(bowtie_like_a_plate) {
    enum { MANY = 1281 };
    static double many_angles[MANY], many_paths[MANY];
    skg_mesh *plate = NULL;
    skg_part part;
    make_bowtie();
    for (int k = 0; k < MANY; k++) {
        many_angles[k] = -32 + 0.05 * k;
        many_paths[k] = 4 / cos((many_angles[k] - 10) * degree);
    }
    bowtie.count = MANY, bowtie.angle_deg = many_angles, bowtie.path_mm = many_paths;
    double *filtered = image_of(&view, beam);
    options.bowtie = NULL;
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cuboid(600, 600, 4, &plate));
    part.mesh = plate, part.material = aluminium, part.label = "plate";
    part.pose[0] = part.pose[10] = cos(10 * degree);
    part.pose[2] = sin(10 * degree), part.pose[8] = -sin(10 * degree); /* its normal leans towards +x */
    part.pose[11] = -700;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&plate);
    double *traced = image_of(&view, beam);
    for (int p = 0; p < PIXELS * PIXELS; p++)
        /* The mesh is in single precision at 300 mm from the source: 2e-5 mm; the profile is linear over 0.05 degrees: 1e-6. */
        ck_assert_double_eq_tol(filtered[p], traced[p], 2 * SINGLE * traced[p]);
    free(filtered);
    free(traced);
}
END_TEST

START_TEST(bowtie_is_absent_or_refused) {
    skg_plan *plan = NULL;
    skg_view parallel = view;
    double wrong[ROWS];
    parallel.projection = SKG_PROJECTION_PARALLEL;
    ck_assert(!effect_is_on(&view, beam, "bow-tie filter", "none is given"));
    make_bowtie();
    ck_assert(!effect_is_on(&parallel, beam, "bow-tie filter", "parallel"));
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_assert(!effect_is_on(&view, mono, "bow-tie filter", "one energy over its flat field"));
    options.quantity = SKG_QUANTITY_ENERGY;
    bowtie.count = 4; /* up to -1.5 degrees */
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "goes from -32 to -1.5 degrees, but rays leave the source from");
    bowtie.count = 1;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE, "1 rows");
    bowtie.count = ROWS;
    memcpy(wrong, angles, sizeof wrong), wrong[3] = wrong[2];
    bowtie.angle_deg = wrong;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE, "row 4");
    bowtie.angle_deg = angles, bowtie.material = NULL;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "no material");
    bowtie.material = aluminium, bowtie.direction[2] = 1;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "along the ray to the detector's centre");
    bowtie.direction[2] = 0, options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "bow-tie");
}
END_TEST

/* --- the grid --- */

static skg_grid grid;

static void make_grid(double focus) {
    skg_grid_init(&grid);
    grid.ratio = 8, grid.lines_per_cm = 40, grid.strip_mm = 0.04, grid.focus_mm = focus;
    grid.interspace = aluminium;
    options.grid = &grid;
    toward[0] = 1, toward[1] = toward[2] = 0;
}

/* The ray's slope across the strips over the detector, less that of the strips there, which meet above the centre. */
static double through_grid(const skg_view *v, int64_t p, double energy) {
    double ray[3], place[3], normal[3], across[3], passed = 0;
    ray_of(v, p, ray);
    place_of(v, p, place);
    normal_of(v, normal);
    for (int k = 0; k < 3; k++) across[k] = toward[k] - dot(toward, normal) * normal[k];
    const double slope = dot(ray, across) / length(across) / fabs(dot(ray, normal));
    const double strips = grid.focus_mm > 0 ? dot(place, across) / length(across) / grid.focus_mm : 0;
    ck_skg(skg_grid_transmission_get(&grid, energy, oblique_of(v, p), slope - strips, &passed));
    return passed;
}

START_TEST(grid_at_and_off_its_focus) {
    skg_view other = view;
    make_grid(1200);
    check(&view, through_grid, BAR); /* the source is at the focus */
    ck_assert(effect_is_on(&view, beam, "anti-scatter grid", "focus at 1200 mm"));
    grid.focus_mm = 1000;
    ck_assert_double_gt(check(&view, through_grid, BAR), 1.2); /* cut-off towards the sides */
    other.source[0] = 40;
    check(&other, through_grid, BAR); /* beside it as well */
    grid.direction[1] = toward[1] = 1, grid.direction[2] = 5, toward[0] = 0;
    check(&other, through_grid, BAR); /* strips along the rows */
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check(&other, through_grid, BAR);
    options.tolerance = 1e-4;
    check(&other, through_grid, BAR + options.tolerance);
    options.tolerance = 0, options.quantity = SKG_QUANTITY_ENERGY;
    grid.interspace = NULL, grid.strip = lead;
    check(&other, through_grid, BAR);
    if (run_has_double()) {
        options.precision = SKG_PRECISION_DOUBLE;
        check(&other, through_grid, BAR);
    }
}
END_TEST

/* Parallel strips cut more off the farther a pixel is from the foot, until hardly anything passes: errors are shares of what
 * passes along the strips. */
START_TEST(grid_of_parallel_strips) {
    make_grid(0);
    double *pixels = image_of(&view, beam), least = 1;
    for (int64_t p = 0; p < PIXELS * PIXELS; p += 5) {
        const double truth = expected(&view, p, through_grid, water_of(&view, p), 0);
        const double open = expected(&view, p, NULL, water_of(&view, p), 0);
        ck_assert_double_eq_tol(pixels[p] / open, truth / open, BAR);
        least = fmin(least, truth / open);
    }
    ck_assert_double_lt(least, 0.3); /* of 110 keV much passes strips of 0.04 mm */
    free(pixels);
    ck_assert(effect_is_on(&view, beam, "anti-scatter grid", "parallel strips"));
}
END_TEST

/* In a parallel beam, parallel strips are at their focus. */
/* High grids far from their focus cut most of the beam off, and 200 mm of water leave its high energies: of what then passes, a tenth and more of the beam,
 * the greatest error is 1.4e-3 (7e-3 where the open beam alone decides which energies count). */
START_TEST(grid_near_cut_off_behind_matter) {
    const double thick[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1};
    ck_skg(skg_scene_part_pose_set(scene, 0, thick));
    for (double ratio = 12; ratio <= 20; ratio += 4) {
        make_grid(900);
        grid.ratio = ratio, toward[0] = 1, toward[1] = 0;
        double *pixels = image_of(&view, beam);
        for (int64_t p = PIXELS * PIXELS / 2; p < PIXELS * PIXELS / 2 + PIXELS; p++) {
            const double truth = expected(&view, p, through_grid, 4 * water_of(&view, p), 0);
            if (truth > 0.1 * expected(&view, p, NULL, 4 * water_of(&view, p), 0))
                ck_assert_double_eq_tol(pixels[p] / truth, 1, 2e-3); /* 1.4e-3, and half as much again */
        }
        free(pixels);
    }
    slab_to(0);
}
END_TEST

START_TEST(grid_in_a_parallel_beam) {
    skg_view parallel = view;
    double at_focus = 0;
    parallel.projection = SKG_PROJECTION_PARALLEL;
    make_grid(0);
    double *pixels = image_of(&parallel, mono);
    ck_skg(skg_grid_transmission_get(&grid, 60, 1, 0, &at_focus));
    const double truth = 1e4 * 60 * exp(-mu(water, 60) * 50) * at_focus;
    for (int p = 0; p < PIXELS * PIXELS; p++) ck_assert_double_eq_tol(pixels[p], truth, SINGLE * truth);
    free(pixels);
}
END_TEST

/* A plan takes views that source, detector and grid have turned to as one, however their numbers are rounded: those of a scan. */
START_TEST(grid_turns_with_the_view) {
    enum { TURNS = 90 };
    skg_plan *plan = NULL;
    make_grid(1200);
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    for (int k = 1; k < TURNS; k++) {
        const double c = cos(360.0 / TURNS * k * degree), s = sin(360.0 / TURNS * k * degree);
        skg_view turned = view;
        double *const vectors[] = {turned.source, turned.centre, turned.column_step, turned.row_step};
        for (int v = 0; v < 4; v++) {
            const double x = vectors[v][0], z = vectors[v][2];
            vectors[v][0] = c * x + s * z, vectors[v][2] = c * z - s * x;
        }
        ck_skg(skg_plan_view_set(plan, &turned));
    }
    skg_plan_release(&plan);
}
END_TEST

START_TEST(grid_is_absent_or_refused) {
    skg_plan *plan = NULL;
    ck_assert(!effect_is_on(&view, beam, "anti-scatter grid", "none is given"));
    make_grid(1000);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    ck_assert(!effect_is_on(&view, mono, "anti-scatter grid", "one energy over its flat field"));
    grid.ratio = -3;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "grid ratio of -3");
    grid.ratio = 8, grid.direction[2] = 1;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_SCENE,
                 "along the detector's normal");
    grid.direction[2] = 0, options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "grid");
}
END_TEST

/* --- together --- */

static double through_both(const skg_view *v, int64_t p, double energy) {
    return through_filter(v, p, energy) * through_grid(v, p, energy);
}

START_TEST(all_together) {
    make_bowtie();
    make_grid(1100);
    options.oblique = 1, options.response = escaping;
    check(&view, through_both, 2 * BAR); /* of the grid and of the scintillator */
    options.tolerance = 1e-4;
    check(&view, through_both, 2 * BAR + options.tolerance);
    options.quantity = SKG_QUANTITY_PHOTONS;
    check(&view, through_both, 2 * BAR + options.tolerance);
}
END_TEST

/* Supersampling and a focal spot: the mean over views that are shifted. */
START_TEST(rays_of_samples) {
    skg_spot spot;
    skg_spot_init(&spot);
    make_bowtie();
    make_grid(1100);
    spot.shape = SKG_SPOT_LINE, spot.extent[0] = 40, spot.grid = 2;
    options.spot = &spot;
    double *pixels = image_of(&view, beam), *truth = calloc(PIXELS * PIXELS, sizeof *truth);
    options.spot = NULL;
    for (int s = 0; s < 2; s++) { /* the middles of the halves */
        for (int64_t p = 0; p < PIXELS * PIXELS; p++) {
            skg_view moved = view;
            moved.source[0] = s ? 10 : -10;
            truth[p] += 0.5 * expected(&moved, p, through_both, water_of(&moved, p), 0);
        }
    }
    for (int64_t p = 0; p < PIXELS * PIXELS; p += 7)
        ck_assert_double_eq_tol(pixels[p], truth[p], BAR * truth[p]);
    free(pixels);
    free(truth);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, bowtie_along_every_ray);
    tcase_add_test(tests, blurred_ratios);
    tcase_add_test(tests, bowtie_like_a_plate);
    tcase_add_test(tests, bowtie_is_absent_or_refused);
    tcase_add_test(tests, grid_at_and_off_its_focus);
    tcase_add_test(tests, grid_of_parallel_strips);
    tcase_add_test(tests, grid_near_cut_off_behind_matter);
    tcase_add_test(tests, grid_in_a_parallel_beam);
    tcase_add_test(tests, grid_turns_with_the_view);
    tcase_add_test(tests, grid_is_absent_or_refused);
    tcase_add_test(tests, all_together);
    tcase_add_test(tests, rays_of_samples);
}

SKG_SUITE_MAIN("in_beam", add_tests)
