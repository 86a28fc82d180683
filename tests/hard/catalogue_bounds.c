/* Bounds: sums that must not wrap, the bound of the precision, and parts within each other by the thousand. */
#include "hard/catalogue.h"
#include "suite.h"
#include "support/drawn.h"
#include "support/faces.h"

#include <math.h>
#include <stdio.h>

static const char *const labels[3] = {"first", "second", "third"};

static skg_scene *scene_of(int count, const solid *solids, const double *mu) {
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    for (int p = 0; p < count; p++) {
        if (!(mu[p] > 0)) continue;
        skg_mesh *mesh = run_mesh(&solids[p]);
        run_part(scene, labels[p], mesh, mu[p], NULL, -1);
        skg_mesh_release(&mesh);
    }
    return scene;
}

static double *image_of(skg_scene *scene, const skg_view *view, int32_t precision, int32_t quantity,
                        double *bound) {
    skg_plan *plan = run_plan(scene, view, (run_choice){.precision = precision, .quantity = quantity});
    double *image = run_image(plan, view);
    if (bound) ck_skg(skg_plan_precision_bound_get(plan, bound));
    skg_plan_release(&plan);
    return image;
}

/* tests/hard/faces_test.c has the first of these scenes. */
static void source_on_faces(hard_outcome *o) {
    enum { SCENES = 2000 };
    o->name = "the source on, at and inside faces";
    o->danger = "a depth below the roundings: sums wrap, and other parts with them";
    o->unit = "of the bar";
    for (int32_t precision = 0; precision <= run_has_double(); precision++) {
        o->worst[precision] = 0, o->bar[precision] = 1;
        for (uint64_t n = 0; n < SCENES; n++) {
            face_scene s = face_scene_make(n);
            skg_scene *scene = scene_of(FACE_PARTS, s.parts, s.mu);
            double *image = image_of(scene, &s.view, precision, SKG_QUANTITY_ATTENUATION, NULL);
            const double worst = face_scene_judge(&s, image, precision == SKG_PRECISION_DOUBLE, 24, n);
            o->worst[precision] = fmax(o->worst[precision], worst);
            if (!(worst <= 1)) hard_fault(o, "%s: %g bars", s.name, worst);
            free(image);
            skg_scene_release(&scene);
            face_scene_free(&s);
        }
    }
}

/* tests/oracle/bound_test.c has the first of these scenes. */
static void bound_of_precision(hard_outcome *o) {
    enum { SCENES = 1000 };
    o->name = "a thousand drawn scenes";
    o->danger = "an error above the bound that the plan states";
    o->unit = "of the stated bound";
    if (!run_has_double()) return;
    o->worst[0] = 0, o->bar[0] = 1;
    for (uint64_t n = 0; n < SCENES; n++) {
        double bound = 0;
        drawn_scene s = drawn_scene_make(n);
        skg_scene *scene = scene_of(s.parts, s.solids, s.mu);
        double *single = image_of(scene, &s.view, SKG_PRECISION_SINGLE, SKG_QUANTITY_TRANSMISSION, &bound);
        double *twice = image_of(scene, &s.view, SKG_PRECISION_DOUBLE, SKG_QUANTITY_TRANSMISSION, NULL);
        /* Images are floats, by half of 2^-23 each. */
        const double worst = drawn_scene_judge(&s, single, twice).outside / (bound + 0x1p-23);
        o->worst[0] = fmax(o->worst[0], worst);
        if (!(worst <= 1)) hard_fault(o, "%s: %g bounds", s.name, worst);
        free(single);
        free(twice);
        skg_scene_release(&scene);
        drawn_scene_free(&s);
    }
}

/* mm, of cube n of 10,000 within each other. */
enum { SHELLS = 10000 };
static double half_of(int n) {
    return 100 - 99.0 * n / SHELLS;
}

/* -ln(I/I0) at (x, y): cubes of 0.2 and 0.1 per cm alternately, each in the place of the one before. */
static double exponent_at(double x, double y, double *nearest) {
    const double at = fmax(fabs(x), fabs(y));
    double sum = 0;
    *nearest = HUGE_VAL;
    for (int n = 0; n < SHELLS; n++) {
        *nearest = fmin(*nearest, fmin(fabs(fabs(x) - half_of(n)), fabs(fabs(y) - half_of(n))));
        if (at < half_of(n)) sum += (n == 0 ? 0.2 : n % 2 ? -0.1 : 0.1) * 0.2 * half_of(n);
    }
    return sum;
}

static skg_scene *cubes(void) {
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    for (int n = 0; n < SHELLS; n++) {
        char label[16];
        skg_mesh *mesh = NULL;
        snprintf(label, sizeof label, "cube %d", n);
        ck_skg(skg_mesh_create_cube(2 * half_of(n), &mesh));
        run_part(scene, label, mesh, n % 2 ? 0.1 : 0.2, NULL, n - 1);
        skg_mesh_release(&mesh);
    }
    return scene;
}

static void nested_shells(hard_outcome *o) {
    const double pitch = 3.17;
    const int64_t side = 64;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options options;
    int64_t overlaps = -1;
    o->name = "ten thousand cubes within each other";
    o->danger = "overlaps compared pair by pair; ten thousand differences to add";
    o->unit = "of -ln(I/I0)";
    skg_scene *scene = cubes();
    skg_view view = run_view(side, pitch);
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_spectrum_create_mono(100, 1, &beam));
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(
        skg_plan_create(run_context, scene, &view, beam, &options, &plan)); /* with the check of overlaps */
    ck_skg(skg_plan_overlap_count(plan, &overlaps));
    if (overlaps != 0) hard_fault(o, "%lld overlaps", (long long)overlaps);
    double *image = run_image(plan, &view);
    o->worst[0] = 0;
    /* 20,000 depths as floats: half of 2^-23 of 0.1 m by 0.1 per cm is 6e-8 each, 8e-6 together at random signs. */
    o->bar[0] = 3e-5;
    for (int64_t p = 0; p < side * side; p++) {
        const double middle = 0.5 * (double)(side - 1);
        double nearest;
        const double truth = exponent_at(pitch * ((double)(p % side) - middle),
                                         pitch * ((double)(p / side) - middle), &nearest);
        if (nearest < 1e-3) continue; /* coordinates are floats of 64 pixels: 4e-6 pixels of 3 mm */
        o->worst[0] = fmax(o->worst[0], fabs(image[p] - truth));
    }
    if (!(o->worst[0] <= o->bar[0])) hard_fault(o, "off by %.3g", o->worst[0]);
    free(image);
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}

const hard_function hard_bounds[] = {nested_shells, source_on_faces, bound_of_precision, NULL};
