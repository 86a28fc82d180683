/* Bow-tie filter, anti-scatter grid and oblique scintillator against sums over the energies, ray by ray. */
#include "support/angles.h"
#include "support/named.h"
#include "support/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = 24, ENERGIES = 12 };

/* The logarithm of what is transmitted is held to this for the whole beam (lib/spectral/directions.c takes directions until
 * 2e-4 is left; where it is worst, twice that is allowed). */
static const double BAR = 4e-4;
/* A bow-tie is one shade and a beam of one energy has one direction, so that single precision is left: 3e-5 of the longest path
 * (docs/numerics.md), whose mu is at most 1. */
static const double SINGLE = 3e-5;

static double kev[ENERGIES], photons[ENERGIES];
static skg_material *water, *csi, *aluminium, *lead;
static skg_response *scintillator, *escaping;
static skg_scene *scene;
static skg_spectrum *beam, *mono;
static skg_plan_options options;
static skg_view view;

static void open_scene(void) {
    skg_mesh *slab = NULL;
    skg_part part;
    run_open();
    water = named("water"), csi = named("CsI"), aluminium = named("Al"), lead = named("Pb");
    for (int e = 0; e < ENERGIES; e++) kev[e] = 22 + 8 * e, photons[e] = 1000 * (e + 1) * (ENERGIES - e);
    ck_skg(skg_spectrum_create_bins(ENERGIES, kev, photons, &beam));
    ck_skg(skg_spectrum_create_mono(60, 1e4, &mono));
    ck_skg(skg_response_create_scintillator(csi, 0.6, 0.8, &scintillator));
    ck_skg(skg_response_create_escaping(scintillator, &escaping));
    ck_skg(skg_mesh_create_cuboid(2000, 2000, 50, &slab));
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    part.mesh = slab, part.material = water, part.label = "slab";
    ck_skg(skg_scene_add(scene, &part, NULL));
    skg_mesh_release(&slab);
    skg_plan_options_init(&options);
    view = run_view(PIXELS, 30); /* 720 mm at 1200 mm: up to 22 degrees from the normal */
}

static void close_scene(void) {
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    skg_spectrum_release(&mono);
    skg_response_release(&scintillator);
    skg_response_release(&escaping);
    skg_material_release(&water);
    skg_material_release(&csi);
    skg_material_release(&aluminium);
    skg_material_release(&lead);
    run_close();
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length(const double *a) {
    return sqrt(dot(a, a));
}

static void cross(const double *a, const double *b, double *c) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* From the detector's centre to pixel p. */
static void place_of(const skg_view *v, int64_t p, double place[3]) {
    const double c = (double)(p % PIXELS) - (PIXELS - 1) / 2.0, r = (double)(p / PIXELS) - (PIXELS - 1) / 2.0;
    for (int k = 0; k < 3; k++) place[k] = c * v->column_step[k] + r * v->row_step[k];
}

static void ray_of(const skg_view *v, int64_t p, double ray[3]) {
    place_of(v, p, ray);
    for (int k = 0; k < 3; k++) ray[k] += v->centre[k] - v->source[k];
}

static void normal_of(const skg_view *v, double normal[3]) {
    cross(v->column_step, v->row_step, normal);
    const double l = length(normal);
    for (int k = 0; k < 3; k++) normal[k] /= l;
}

/* Path through the detector over its thickness. */
static double oblique_of(const skg_view *v, int64_t p) {
    double ray[3], normal[3];
    ray_of(v, p, ray);
    normal_of(v, normal);
    return length(ray) / fabs(dot(ray, normal));
}

static double mu(const skg_material *material, double energy) { /* 1/mm */
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, energy, &per_cm));
    return per_cm / 10;
}

/* The share of photons of an energy that reaches pixel p through what a test puts into the beam. */
typedef double passing(const skg_view *v, int64_t p, double energy);

/* keV, or photons, that pixel p records behind mm of water. pass NULL: 1. oblique: of the scintillator; 0: ideal. */
static double expected(const skg_view *v, int64_t p, passing *pass, double mm, double oblique) {
    double sum = 0;
    for (int e = 0; e < ENERGIES; e++) {
        double recorded = kev[e], efficiency = 1;
        if (oblique > 0) ck_skg(skg_response_get(options.response, kev[e], oblique, &recorded, &efficiency));
        sum += photons[e] * (options.quantity == SKG_QUANTITY_PHOTONS ? efficiency : recorded) *
               exp(-mu(water, kev[e]) * mm) * (pass ? pass(v, p, kev[e]) : 1);
    }
    return sum;
}

static double *image_of(const skg_view *v, skg_spectrum *spectrum) {
    skg_plan *plan = NULL;
    ck_skg(skg_plan_create(run_context, scene, v, spectrum, &options, &plan));
    double *pixels = run_image(plan, v);
    skg_plan_release(&plan);
    return pixels;
}

static double water_of(const skg_view *v, int64_t p) {
    double ray[3];
    ray_of(v, p, ray);
    return 50 * length(ray) / fabs(ray[2]);
}

/* Every seventh pixel, which are some of every row and column. Returns the greatest over the least. */
static double check(const skg_view *v, passing *pass, double bar) {
    double *pixels = image_of(v, beam), low = HUGE_VAL, high = 0;
    const int ratio = options.quantity == SKG_QUANTITY_TRANSMISSION;
    for (int64_t p = 0; p < PIXELS * PIXELS; p += 7) {
        const double oblique = options.oblique ? oblique_of(v, p) : options.response ? 1 : 0;
        double truth = expected(v, p, pass, water_of(v, p), oblique);
        if (ratio) truth /= expected(v, p, pass, 0, oblique);
        ck_assert_msg(fabs(pixels[p] / truth - 1) <= bar, "pixel %d: %.8g instead of %.8g", (int)p, pixels[p],
                      truth);
        low = fmin(low, pixels[p]), high = fmax(high, pixels[p]);
    }
    free(pixels);
    return high / low;
}

/* The reason that a plan gives for an effect, and whether it is on. */
static int effect_is_on(const skg_view *v, skg_spectrum *spectrum, const char *name, const char *reason) {
    skg_plan *plan = NULL;
    int64_t count = 0, found = -1;
    skg_effect effect;
    ck_skg(skg_plan_create(run_context, scene, v, spectrum, &options, &plan));
    ck_skg(skg_plan_effect_count(plan, &count));
    for (int64_t e = 0; e < count && found < 0; e++) {
        skg_effect_init(&effect);
        ck_skg(skg_plan_effect_get(plan, e, &effect));
        if (strcmp(effect.name, name) == 0) found = e;
    }
    ck_assert_int_ge(found, 0);
    ck_assert_msg(strstr(effect.reason, reason) != NULL, "%s: \"%s\" has no \"%s\"", name, effect.reason,
                  reason);
    ck_assert(!effect.on || effect.cost >= 0);
    const int on = effect.on;
    skg_plan_release(&plan);
    return on;
}

/* --- the scintillator --- */

static skg_view tilted(double degrees) {
    skg_view v = view;
    v.column_step[0] = 30 * cos(degrees * degree), v.column_step[2] = 30 * sin(degrees * degree);
    v.column_step[0] /= 2, v.column_step[2] /= 2; /* half the detector, so that it stays behind the slab */
    return v;
}

START_TEST(oblique_rays) {
    const skg_view turned = tilted(35);
    options.oblique = 1, options.response = scintillator;
    check(&view, NULL, BAR);
    check(&turned, NULL, BAR);
    options.quantity = SKG_QUANTITY_PHOTONS;
    check(&turned, NULL, BAR);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check(&turned, NULL, BAR);
    options.tolerance = 1e-4;
    check(&turned, NULL, BAR + options.tolerance);
    options.tolerance = 0, options.quantity = SKG_QUANTITY_ENERGY, options.response = escaping;
    check(&turned, NULL, BAR);
    if (run_has_double()) {
        options.precision = SKG_PRECISION_DOUBLE;
        check(&turned, NULL, BAR);
    }
}
END_TEST

/* One energy: (1 - exp(-mu t / cos beta)) / (1 - exp(-mu t)) times what photons that cross it straight would give. */
START_TEST(oblique_slab_of_one_energy) {
    options.response = scintillator;
    double *straight = image_of(&view, mono), most = 0;
    options.oblique = 1;
    double *pixels = image_of(&view, mono);
    for (int64_t p = 0; p < PIXELS * PIXELS; p++) {
        const double all = mu(csi, 60) * 0.48;
        const double truth = expm1(-all * oblique_of(&view, p)) / expm1(-all);
        /* Some 30 roundings of floats, 6e-8 each. */
        ck_assert_double_eq_tol(pixels[p] / straight[p], truth, 2e-6);
        most = fmax(most, truth);
    }
    ck_assert_double_gt(most, 1.02); /* the effect */
    free(straight);
    free(pixels);
}
END_TEST

/* A parallel beam has one angle to the detector, and noise of what is recorded there. */
START_TEST(oblique_parallel_beam_with_noise) {
    enum { SIDE = 128, COUNT = SIDE * SIDE };
    const double angle = 40 * degree, s = 1 / cos(angle);
    skg_view v;
    skg_view_init(&v);
    v.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    v.columns = v.rows = SIDE, v.source[2] = 1, v.centre[2] = 300;
    v.column_step[0] = 0.2 * cos(angle), v.column_step[2] = 0.2 * sin(angle), v.row_step[1] = 0.2;
    options.oblique = 1, options.noise = 1, options.response = escaping;
    double *pixels = image_of(&v, beam), mean = 0, variance = 0, truth = 0, truth_variance = 0;
    for (int64_t p = 0; p < COUNT; p++) mean += pixels[p] / COUNT;
    for (int64_t p = 0; p < COUNT; p++) variance += pow(pixels[p] - mean, 2) / (COUNT - 1);
    for (int e = 0; e < ENERGIES; e++) {
        double recorded = 0, efficiency = 0, swank = 0;
        const double arrive = photons[e] * exp(-mu(water, kev[e]) * 50);
        ck_skg(skg_response_get(escaping, kev[e], s, &recorded, &efficiency));
        ck_skg(skg_response_swank_get(escaping, kev[e], s, &swank));
        truth += arrive * recorded;
        truth_variance += arrive * recorded * recorded / (efficiency * swank);
    }
    /* Four standard errors; the variance changes with the angle as the mean does, which docs/physics.md states to 0.5 %. */
    ck_assert_double_eq_tol(mean, truth, 4 * sqrt(truth_variance / COUNT) + BAR * truth);
    ck_assert_double_eq_tol(variance, truth_variance, (4 * sqrt(2.0 / COUNT) + 5e-3) * truth_variance);
    free(pixels);
    ck_assert(effect_is_on(&v, beam, "oblique scintillator", "1.3"));
    ck_assert(effect_is_on(&v, beam, "K escape", "pulse heights"));
}
END_TEST

START_TEST(oblique_is_absent_or_refused) {
    skg_plan *plan = NULL;
    skg_view straight = view;
    straight.projection = SKG_PROJECTION_PARALLEL;
    ck_assert(!effect_is_on(&view, beam, "oblique scintillator", "ideal"));
    ck_assert(!effect_is_on(&view, beam, "K escape", "ideal"));
    options.response = scintillator;
    ck_assert(!effect_is_on(&view, beam, "oblique scintillator", "not asked for"));
    ck_assert(!effect_is_on(&view, beam, "K escape", "not asked for"));
    double *plain = image_of(&straight, beam);
    options.oblique = 1;
    ck_assert(!effect_is_on(&straight, beam, "oblique scintillator", "straight"));
    double *same = image_of(&straight, beam);
    ck_assert_mem_eq(plain, same, PIXELS * PIXELS * sizeof *plain);
    free(plain);
    free(same);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    ck_assert(!effect_is_on(&view, mono, "oblique scintillator", "one energy over its flat field"));
    options.response = NULL;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_ARGUMENT,
                 "the detector is ideal");
    options.response = scintillator, options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "oblique");
}
END_TEST

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
    ck_skg(skg_scene_add(scene, &part, NULL));
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
    tcase_add_test(tests, oblique_rays);
    tcase_add_test(tests, oblique_slab_of_one_energy);
    tcase_add_test(tests, oblique_parallel_beam_with_noise);
    tcase_add_test(tests, oblique_is_absent_or_refused);
    tcase_add_test(tests, bowtie_along_every_ray);
    tcase_add_test(tests, bowtie_like_a_plate);
    tcase_add_test(tests, bowtie_is_absent_or_refused);
    tcase_add_test(tests, grid_at_and_off_its_focus);
    tcase_add_test(tests, grid_of_parallel_strips);
    tcase_add_test(tests, grid_in_a_parallel_beam);
    tcase_add_test(tests, grid_is_absent_or_refused);
    tcase_add_test(tests, all_together);
    tcase_add_test(tests, rays_of_samples);
}

SKG_SUITE_MAIN("in_beam", add_tests)
