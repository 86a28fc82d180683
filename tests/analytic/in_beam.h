/* Shared code of tests of objects in the beam: a slab of water before a detector of 24 x 24 pixels, and sums over the energies ray by ray. */
#ifndef SKG_TESTS_IN_BEAM_H
#define SKG_TESTS_IN_BEAM_H

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

static inline void open_scene(void) {
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
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&slab);
    skg_plan_options_init(&options);
    view = run_view(PIXELS, 30); /* 720 mm at 1200 mm: up to 22 degrees from the normal */
}

static inline void close_scene(void) {
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

static inline double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double length(const double *a) {
    return sqrt(dot(a, a));
}

static inline void cross(const double *a, const double *b, double *c) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* From the detector's centre to pixel p. */
static inline void place_of(const skg_view *v, int64_t p, double place[3]) {
    const double c = (double)(p % PIXELS) - (PIXELS - 1) / 2.0, r = (double)(p / PIXELS) - (PIXELS - 1) / 2.0;
    for (int k = 0; k < 3; k++) place[k] = c * v->column_step[k] + r * v->row_step[k];
}

static inline void ray_of(const skg_view *v, int64_t p, double ray[3]) {
    place_of(v, p, ray);
    for (int k = 0; k < 3; k++) ray[k] += v->centre[k] - v->source[k];
}

static inline void normal_of(const skg_view *v, double normal[3]) {
    cross(v->column_step, v->row_step, normal);
    const double l = length(normal);
    for (int k = 0; k < 3; k++) normal[k] /= l;
}

/* Path through the detector over its thickness. */
static inline double oblique_of(const skg_view *v, int64_t p) {
    double ray[3], normal[3];
    ray_of(v, p, ray);
    normal_of(v, normal);
    return length(ray) / fabs(dot(ray, normal));
}

static inline double mu(const skg_material *material, double energy) { /* 1/mm */
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, energy, &per_cm));
    return per_cm / 10;
}

/* The share of photons of an energy that reaches pixel p through what a test puts into the beam. */
typedef double passing(const skg_view *v, int64_t p, double energy);

/* keV, or photons, that pixel p records behind mm of water. pass NULL: 1. oblique: of the scintillator; 0: ideal. */
static inline double expected(const skg_view *v, int64_t p, passing *pass, double mm, double oblique) {
    double sum = 0;
    for (int e = 0; e < ENERGIES; e++) {
        double recorded = kev[e], efficiency = 1;
        if (oblique > 0) ck_skg(skg_response_get(options.response, kev[e], oblique, &recorded, &efficiency));
        sum += photons[e] * (options.quantity == SKG_QUANTITY_PHOTONS ? efficiency : recorded) *
               exp(-mu(water, kev[e]) * mm) * (pass ? pass(v, p, kev[e]) : 1);
    }
    return sum;
}

static inline double *image_of(const skg_view *v, skg_spectrum *spectrum) {
    skg_plan *plan = NULL;
    ck_skg(skg_plan_create(run_context, scene, v, spectrum, &options, &plan));
    double *pixels = run_image(plan, v);
    skg_plan_release(&plan);
    return pixels;
}

static inline double water_of(const skg_view *v, int64_t p) {
    double ray[3];
    ray_of(v, p, ray);
    return 50 * length(ray) / fabs(ray[2]);
}

/* Every seventh pixel, which are some of every row and column. Returns the greatest over the least. */
static inline double check(const skg_view *v, passing *pass, double bar) {
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
static inline int effect_is_on(const skg_view *v, skg_spectrum *spectrum, const char *name,
                               const char *reason) {
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

#endif
