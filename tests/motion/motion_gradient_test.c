/* The gradient of a body that breathes: chained with how its vertices follow a parameter of the breath, it is the derivative by that
 * parameter. */
#include "motion/motion_files.h"

#include <skiagraph/gradient.h>
#include <skiagraph/plan.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 48, PIXELS = SIDE * SIDE, PARTS = 3 };

/* The body at one amplitude of the diaphragm, and its image. */
typedef struct {
    double *positions[PARTS], image[PIXELS];
    int64_t vertices[PARTS];
} posed;

static const double LEAST = 1e-3; /* of the largest slope: positions are floats, 4e-6 mm of 0.09 mm */

static skg_context *context;
static skg_plan *plan;

static void open_body(double diaphragmatic) {
    FILE *stream = fopen(path, "w");
    ck_assert_ptr_nonnull(stream);
    fprintf(
        stream,
        "%s  {\"Label\": \"lung right\", \"Sphere\": [24, 40, \"mm\"], \"Material\": [\"mu\", 0.05]},\n"
        "  {\"Label\": \"flat\", \"Sphere\": [17, 60, \"mm\"], \"Material\": [\"mu\", 0.2]},\n"
        "  {\"Label\": \"inside\", \"Sphere\": [12, 15, \"mm\"], \"Material\": [\"mu\", 0.3], \"Parent\": "
        "\"lung right\"}], \"Breathing\": {\"Waveform\": \"Sine\", \"Thoracic\": 0.5, \"Diaphragmatic\": %.17g, "
        "\"LungDensity\": false, \"Organs\": {\"flat\": {\"As\": \"diaphragm\"}}}}\n",
        heading, diaphragmatic);
    ck_assert_int_eq(fclose(stream), 0);
    close_setup();
    ck_skg(skg_setup_load(context, path, 0, NULL, &setup));
    ck_skg(skg_motion_create(context, setup, &motion));
    ck_skg(skg_motion_pose_at_phase(motion, 0.21));
}

static void make_plan(void) {
    skg_plan_options options;
    skg_spectrum *spectrum;
    skg_scene *scene;
    skg_view view;
    skg_view_init(&view);
    skg_plan_options_init(&options);
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    ck_skg(skg_setup_view_get(setup, &view));
    for (int k = 0; k < 3; k++) {
        view.column_step[k] *= 16.0 / SIDE / 2;
        view.row_step[k] *= 16.0 / SIDE / 2;
    }
    view.columns = view.rows = SIDE;
    options.precision = SKG_PRECISION_DOUBLE, options.quantity = SKG_QUANTITY_ATTENUATION,
    options.overlaps = 0;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
}

static void render(double diaphragmatic, posed *body) {
    skg_output output;
    open_body(diaphragmatic);
    make_plan();
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = body->image;
    ck_skg(skg_plan_image(plan, &output));
    for (int64_t p = 0; p < PARTS; p++) {
        skg_part part;
        int64_t triangles;
        skg_part_init(&part);
        ck_skg(skg_scene_part_get(setup->scene, p, &part));
        ck_skg(skg_mesh_count(part.mesh, &body->vertices[p], &triangles));
        body->positions[p] = calloc(3 * (size_t)body->vertices[p], sizeof(double));
        ck_skg(skg_mesh_positions_get(part.mesh, body->positions[p], 0));
    }
    skg_plan_release(&plan);
}

static void free_body(posed *body) {
    for (int p = 0; p < PARTS; p++) free(body->positions[p]);
}

/* The derivative of every pixel by the amplitude, from bodies at the amplitude, and ahead and behind by a step and by half of it; NAN
 * where hits change within them: there the two slopes disagree, or those to both sides are not nearer to each other at half the step. */
static int64_t differentiate(const posed bodies[5], double step, double *slope) {
    const double *here = bodies[0].image;
    double largest = 0;
    int64_t used = 0;
    for (int p = 0; p < PIXELS; p++)
        largest = fmax(largest, fabs(bodies[1].image[p] - bodies[2].image[p]) / (2 * step));
    for (int p = 0; p < PIXELS; p++) {
        const double *image[5];
        for (int b = 0; b < 5; b++) image[b] = bodies[b].image + p;
        const double whole = (*image[1] - *image[2]) / (2 * step), half = (*image[3] - *image[4]) / step;
        const double bend = (*image[1] - 2 * here[p] + *image[2]) / step;
        const double half_bend = 2 * (*image[3] - 2 * here[p] + *image[4]) / step;
        const int is_smooth =
            fabs(half - whole) <= LEAST * largest && fabs(bend - 2 * half_bend) <= LEAST * largest;
        slope[p] = is_smooth ? (4 * half - whole) / 3 : (double)NAN;
        used += is_smooth && half != 0;
    }
    return used;
}

START_TEST(a_gradient_chains_to_the_amplitude_of_the_breath) {
    static posed bodies[5];
    static double slope[PIXELS], weights[PIXELS];
    const double amplitude = 1.3, step = 1e-2, shares[5] = {0, 1, -1, 0.5, -0.5};
    double *vertices[PARTS], expected = 0, size = 0, got = 0, fastest = 0;
    skg_gradient gradient;
    skg_adjoint adjoint;
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_context_device_get(context, &info));
    if (!info.double_precision) return;
    for (int b = 0; b < 5; b++) render(amplitude + shares[b] * step, &bodies[b]);
    const int64_t used = differentiate(bodies, step, slope);
    for (int p = 0; p < PIXELS; p++) {
        weights[p] = isnan(slope[p]) ? 0 : sin(0.3 * p);
        if (weights[p] == 0) continue;
        expected += weights[p] * slope[p];
        size += fabs(weights[p] * slope[p]);
    }
    open_body(amplitude);
    make_plan();
    skg_gradient_init(&gradient);
    skg_adjoint_init(&adjoint);
    adjoint.channels = 1, adjoint.rows = adjoint.columns = SIDE, adjoint.data = weights;
    for (int p = 0; p < PARTS; p++) vertices[p] = calloc(3 * (size_t)bodies[0].vertices[p], sizeof(double));
    gradient.vertices = vertices;
    ck_skg(skg_plan_gradient(plan, NULL, &adjoint, &gradient));
    for (int p = 0; p < PARTS; p++)
        for (int64_t k = 0; k < 3 * bodies[0].vertices[p]; k++) {
            const double moves = (bodies[3].positions[p][k] - bodies[4].positions[p][k]) / step;
            fastest = fmax(fastest, fabs(moves));
            got += vertices[p][k] * moves;
        }
    ck_assert_double_gt(fastest, 1);
    ck_assert_int_gt(used, PIXELS / 8);
    /* Positions are floats: 4e-6 mm of the 0.05 mm of half a step, at random; 7e-6 were seen */
    ck_assert_double_eq_tol(got, expected, 1e-4 * size);
    for (int p = 0; p < PARTS; p++) free(vertices[p]);
    for (int b = 0; b < 5; b++) free_body(&bodies[b]);
    skg_plan_release(&plan);
}
END_TEST

static void open_all(void) {
    set_up();
    ck_skg(skg_context_create(NULL, &context));
}

static void close_all(void) {
    tear_down();
    skg_context_release(&context);
}

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_all, close_all);
    tcase_add_test(tests, a_gradient_chains_to_the_amplitude_of_the_breath);
}

SKG_SUITE_MAIN("motion_gradient", add_tests)
