/* Images whose truth is known in every pixel. */
#include "hard/catalogue.h"
#include "suite.h"
#include "support/caster.h"
#include "support/random.h"

#include <math.h>
#include <stdio.h>

enum { SIDE = 64, PIXELS = SIDE * SIDE };

/* Truth of an image, and its bar: |got - truth| / max(truth, least) at pixels where truth is no NAN. */
typedef struct {
    int32_t quantity;
    double truth[PIXELS], least, bar[2];
} judgement;

static skg_plan *plan_with(skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                           run_choice choice) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    if (!spectrum) return run_plan(scene, view, choice);
    skg_plan_options_init(&options);
    options.precision = choice.precision;
    options.strategy = choice.strategy;
    options.quantity = choice.quantity;
    options.overlaps = 0;
    ck_skg(skg_plan_create(run_context, scene, view, spectrum, &options, &plan));
    return plan;
}

static void judge_pixels(hard_outcome *o, const judgement *j, int32_t precision, const double *got) {
    double worst = 0;
    for (int p = 0; p < PIXELS; p++)
        if (!isnan(j->truth[p]))
            worst = fmax(worst, fabs(got[p] - j->truth[p]) / fmax(fabs(j->truth[p]), j->least));
    o->worst[precision] = worst;
    o->bar[precision] = j->bar[precision];
    if (!(worst <= j->bar[precision])) hard_fault(o, "worst %.3g", worst);
    hard_check_values(o, got, PIXELS, -j->bar[precision] * j->least);
}

/* Takes the images in both precisions, by all strategies. spectrum NULL: 100 keV. */
static void judge_scene(hard_outcome *o, const judgement *j, skg_scene *scene, const skg_view *view,
                        skg_spectrum *spectrum) {
    for (int32_t precision = 0; precision <= run_has_double(); precision++) {
        uint64_t first = 0;
        for (int way = 0; way < HARD_WAYS; way++) {
            run_choice choice = hard_ways[way];
            choice.precision = precision;
            choice.quantity = j->quantity;
            skg_plan *plan = plan_with(scene, view, spectrum, choice);
            double *got = run_image(plan, view);
            hard_same_bits(o, way, got, PIXELS, &first);
            if (way == 0) judge_pixels(o, j, precision, got);
            if (way == 0 && precision == SKG_PRECISION_SINGLE) hard_compare_time(o, scene, plan, view);
            free(got);
            skg_plan_release(&plan);
        }
    }
}

/* truth += weight * lengths of a solid by the caster; NAN stays. */
static void add_cast(judgement *j, const solid *s, const double *pose, const skg_view *view, double weight) {
    caster *c = caster_create(s, pose);
    for (int p = 0; p < PIXELS; p++)
        j->truth[p] +=
            weight * (double)caster_length(c, view, (long double)(p % SIDE), (long double)(p / SIDE));
    caster_free(c);
}

static double largest_truth(const judgement *j) {
    double largest = 0;
    for (int p = 0; p < PIXELS; p++) largest = fmax(largest, j->truth[p]);
    return largest;
}

static void part_of(skg_scene *scene, const char *label, const solid *s, double mu, int64_t inside) {
    skg_mesh *mesh = run_mesh(s);
    run_part(scene, label, mesh, mu, NULL, inside);
    skg_mesh_release(&mesh);
}

/* --- transmission ---------------------------------------------------------------------------------------- */

static void transmission(hard_outcome *o) {
    enum { STEPS = 16 };
    static judgement j = {.quantity = SKG_QUANTITY_TRANSMISSION, .least = 1e-30, .bar = {5e-5, 1e-11}};
    o->name = "transmission from 1 to 1e-30 and beyond";
    o->danger = "exp of -200 leaves the range of floats; small ones lose digits";
    o->unit = "relative, above 1e-30";
    skg_view view = run_view(SIDE, 1);
    view.projection = SKG_PROJECTION_PARALLEL;
    solid all = solid_box(0.01, 0.01, 0.01);
    for (int n = 1; n < STEPS; n++) { /* 4 columns each; 6 mm more, exponent 12 more */
        solid step = solid_box(4, 200, 6.0 * n);
        solid_shift(&step, 4.0 * n - 30, 0, 0);
        solid_add(&all, &step);
        solid_free(&step);
    }
    for (int p = 0; p < PIXELS; p++) j.truth[p] = exp(-2 * 6.0 * (p % SIDE / 4));
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    part_of(scene, "steps", &all, 20, -1);
    judge_scene(o, &j, scene, &view, NULL);
    skg_scene_release(&scene);
    solid_free(&all);
}

/* A plate of iodine under a parallel beam of two lines. */
static void iodine(hard_outcome *o, judgement *j, skg_spectrum *spectrum, const double kev[2]) {
    skg_view view = run_view(SIDE, 1);
    skg_part part;
    skg_scene *scene = NULL;
    double mu[2];
    solid plate = solid_box(200, 200, 0.1);
    view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    part.mesh = run_mesh(&plate);
    part.label = "iodine";
    ck_skg(skg_material_create_element(53, &part.material));
    for (int k = 0; k < 2; k++) ck_skg(skg_material_attenuation_get(part.material, kev[k], &mu[k]));
    if (!(mu[1] > 4 * mu[0])) hard_fault(o, "mu goes from %g to %g per cm: there is no edge", mu[0], mu[1]);
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    for (int p = 0; p < PIXELS; p++)
        j->truth[p] = (kev[0] * exp(-0.01 * mu[0]) + kev[1] * exp(-0.01 * mu[1])) / (kev[0] + kev[1]);
    judge_scene(o, j, scene, &view, spectrum);
    skg_scene_release(&scene);
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    solid_free(&plate);
}

static void k_edge(hard_outcome *o) {
    static judgement j = {.quantity = SKG_QUANTITY_TRANSMISSION, .least = 1e-6, .bar = {2e-6, 1e-12}};
    const double kev[2] = {33.168, 33.171}, photons[2] = {1, 1}; /* the edge: 33.1694 keV */
    skg_spectrum *spectrum = NULL;
    o->name = "lines on both sides of a K edge";
    o->danger = "interpolation across the edge smears it";
    o->unit = "relative";
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &spectrum));
    iodine(o, &j, spectrum, kev);
    skg_spectrum_release(&spectrum);
}

static void empty_bins(hard_outcome *o) {
    static judgement j = {.quantity = SKG_QUANTITY_TRANSMISSION, .least = 1e-6, .bar = {2e-6, 1e-12}};
    const double line[2] = {33.168, 33.171};
    double kev[100], photons[100];
    skg_spectrum *spectrum = NULL;
    o->name = "a spectrum with empty bins";
    o->danger = "0 / 0 in means; bins that cost and give nothing";
    o->unit = "relative";
    for (int n = 0; n < 100; n++) {
        kev[n] = n == 32 ? line[0] : n == 33 ? line[1] : n + 1;
        photons[n] = n == 32 || n == 33 ? 1 : 0;
    }
    ck_skg(skg_spectrum_create_bins(100, kev, photons, &spectrum));
    iodine(o, &j, spectrum, line);
    skg_spectrum_release(&spectrum);
}

/* --- parts ----------------------------------------------------------------------------------------------- */

static void neighbours(hard_outcome *o) {
    static judgement j = {.quantity = SKG_QUANTITY_ATTENUATION, .bar = {3e-6, 1e-11}};
    o->name = "parts that share a face";
    o->danger = "a gap or an overlap at the shared face";
    o->unit = "of the largest exponent";
    const skg_view view = run_view(SIDE, 2.1);
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    for (int n = 0; n < 4; n++) {
        char label[16];
        solid box = solid_box(40, 30, 50);
        solid_shift(&box, 40 * (n & 1) - 20 + 0.37, 0, 50 * (n >> 1) - 25);
        snprintf(label, sizeof label, "box %d", n);
        part_of(scene, label, &box, 0.1 * (n + 1), -1);
        add_cast(&j, &box, NULL, &view, 0.01 * (n + 1));
        solid_free(&box);
    }
    j.least = largest_truth(&j);
    judge_scene(o, &j, scene, &view, NULL);
    skg_scene_release(&scene);
}

static void shells(hard_outcome *o) {
    enum { SHELLS = 12 };
    static judgement j = {.quantity = SKG_QUANTITY_ATTENUATION, .bar = {3e-5, 1e-10}};
    o->name = "nested shells of 2 micrometres";
    o->danger = "each shell is the small difference of two large lengths";
    o->unit = "of the largest exponent";
    const skg_view view = run_view(SIDE, 2.1);
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    for (int n = 0; n < SHELLS; n++) { /* each displaces the one around it */
        char label[16];
        const double mu = n & 1 ? 0.5 : 0.1, around = n == 0 ? 0 : n & 1 ? 0.1 : 0.5;
        solid ball = solid_sphere(45 - 0.002 * n, 60, 30);
        snprintf(label, sizeof label, "shell %d", n);
        part_of(scene, label, &ball, mu, n - 1);
        add_cast(&j, &ball, NULL, &view, 0.1 * (mu - around));
        solid_free(&ball);
    }
    j.least = largest_truth(&j);
    judge_scene(o, &j, scene, &view, NULL);
    skg_scene_release(&scene);
}

static void overlapping(hard_outcome *o) {
    enum { PARTS = 3000 };
    static judgement j = {.quantity = SKG_QUANTITY_ATTENUATION, .bar = {1e-5, 1e-11}};
    uint64_t seed = 9;
    o->name = "3000 overlapping parts";
    o->danger = "the sum of all wraps; a launch for each part";
    o->unit = "of the largest exponent";
    const skg_view view = run_view(SIDE, 2.1);
    skg_scene *scene = NULL;
    solid one = solid_tetrahedra(1, 30, (const double[3]){1, 1, 1}, 3), all = {0};
    skg_mesh *mesh = run_mesh(&one);
    ck_skg(skg_scene_create(run_context, &scene));
    for (int n = 0; n < PARTS; n++) {
        char label[16];
        double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, shift[3];
        solid moved = solid_copy(&one);
        for (int k = 0; k < 3; k++) pose[4 * k + 3] = shift[k] = draw(&seed, -40, 40);
        solid_shift(&moved, shift[0], shift[1], shift[2]);
        snprintf(label, sizeof label, "part %d", n);
        run_part(scene, label, mesh, 0.01, pose, -1);
        if (n)
            solid_add(&all, &moved), solid_free(&moved);
        else
            all = moved;
    }
    skg_mesh_release(&mesh);
    caster *c = caster_create(&all, NULL);
    for (int p = 0; p < PIXELS; p++) /* every 13th pixel: the caster is slow */
        j.truth[p] =
            p % 13 ? (double)NAN
                   : 1e-3 * (double)caster_length(c, &view, (long double)(p % SIDE), (long double)(p / SIDE));
    caster_free(c);
    j.least = largest_truth(&j);
    judge_scene(o, &j, scene, &view, NULL);
    skg_scene_release(&scene);
    solid_free(&one);
    solid_free(&all);
}

/* A beam from very far against the parallel one. */
static void far_beam(hard_outcome *o) {
    static judgement j = {.quantity = SKG_QUANTITY_ATTENUATION, .bar = {1e-3, 1e-3}};
    o->name = "source at 1e9 mm against the parallel beam";
    o->danger = "two paths through the kernels that have to agree";
    o->unit = "of the largest exponent";
    skg_view far = run_view(SIDE, 2.1), parallel = far;
    far.source[2] = -1e9;
    parallel.projection = SKG_PROJECTION_PARALLEL;
    solid blob = solid_blob(55, 60, 30, 10);
    skg_scene *scene = run_scene(&blob, NULL);
    skg_plan *plan = run_plan(
        scene, &parallel, (run_choice){.precision = run_has_double(), .quantity = SKG_QUANTITY_ATTENUATION});
    double *straight = run_image(plan, &parallel);
    for (int p = 0; p < PIXELS; p++) j.truth[p] = straight[p];
    j.least = largest_truth(&j);
    free(straight);
    skg_plan_release(&plan);
    judge_scene(o, &j, scene, &far, NULL);
    skg_scene_release(&scene);
    solid_free(&blob);
}

const hard_function hard_images[] = {transmission, k_edge,      empty_bins, neighbours,
                                     shells,       overlapping, far_beam,   NULL};
