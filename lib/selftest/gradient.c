/* Gradients against the formula of the boxes: what it changes when a part or the source moves by a small step, in double precision. */
#include "selftest/selftest.h"

#include <skiagraph/gradient.h>

#include <math.h>
#include <stdio.h>

enum { N = SKG_SELF_TEST_PIXELS / 2, PIXELS = N * N, WAYS = 9 };

/* Hits of single precision may belong to the face beside theirs; a kernel that is wrong is so by far more. */
static const double TOLERANCE = 1e-3;

typedef struct {
    skg_self_test_scene scene;
    skg_plan *plan;
    double adjoint[PIXELS], derivative[PIXELS];
    double poses[2][6], source[3];
} gradient_run;

/* Moves part 0 or 1, or the source, along an axis. */
static void move(skg_self_test_scene *scene, int way, double step) {
    const int axis = way % 3, end = SKG_SELF_TEST_BOXES;
    if (way >= 6) scene->view.source[axis] += step;
    for (int b = 0; b < end && way < 3; b++) scene->boxes[b].centre[axis] += step;
    if (way >= 3 && way < 6) scene->boxes[end].centre[axis] += step;
}

/* The attenuation that a pixel shows. */
static double attenuation_of(const skg_self_test_scene *scene, int pixel) {
    const double shares[SKG_SELF_TEST_ENERGIES_MAX] = {1, 1, 1};
    double surface, net[2], open;
    skg_self_test_lengths(scene, pixel / N, pixel % N, &surface, net);
    const double shown = skg_self_test_intensity(scene, shares, net, &open);
    return -log(shown / open);
}

/* Difference quotient of the loss, and the sum of the magnitudes over the pixels. */
static double differentiate(gradient_run *run, int way, double *size) {
    const double step = 1e-5;
    double sum = 0;
    *size = 0;
    for (int p = 0; p < PIXELS; p++) {
        move(&run->scene, way, step);
        double change = attenuation_of(&run->scene, p);
        move(&run->scene, way, -2 * step);
        change = run->adjoint[p] * (change - attenuation_of(&run->scene, p)) / (2 * step);
        move(&run->scene, way, step);
        sum += change;
        *size += fabs(change);
    }
    return sum;
}

static void note(skg_verdict *verdict, const char *what, int way, double got, double wanted) {
    static const char *const moves[3] = {"boxes", "box", "source"};
    static const char axes[] = "xyz";
    verdict->good = 0;
    snprintf(verdict->reason, sizeof verdict->reason,
             "%s of %d x %d pixels by the %s of the %s is %.7g instead of %.7g per mm", what, N, N,
             (const char[]){axes[way % 3], 0}, moves[way / 3], got, wanted);
}

/* Along the way of a part that is the gradient's entry. */
static skg_status compare_forward(gradient_run *run, int way, double size, skg_verdict *verdict) {
    double twists[2][6] = {{0}}, sum = 0;
    skg_direction direction;
    skg_output output;
    twists[way / 3][way % 3] = 1;
    skg_direction_init(&direction);
    direction.poses = twists[0];
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64;
    output.data = run->derivative;
    SKG_TRY(skg_plan_derivatives(run->plan, NULL, 1, &direction, &output, NULL));
    for (int p = 0; p < PIXELS; p++) sum += run->adjoint[p] * run->derivative[p];
    if (!(fabs(sum - run->poses[way / 3][way % 3]) <= TOLERANCE * size))
        note(verdict, "the sum of the derivatives", way, sum, run->poses[way / 3][way % 3]);
    return SKG_OK;
}

/* Of a scene with a volume there are derivatives by the part that displaces it alone. */
static skg_status compare(gradient_run *run, skg_verdict *verdict) {
    const int has_cells = run->scene.number == SKG_SELF_TEST_CELLS;
    const int forward = has_cells ? 0 : 3; /* the first of the ways that are compared with a direction */
    for (int way = 0; way < (has_cells ? 3 : WAYS) && verdict->good; way++) {
        double size;
        const double wanted = differentiate(run, way, &size);
        const double got = way < 6 ? run->poses[way / 3][way % 3] : run->source[way % 3];
        if (!(fabs(got - wanted) <= TOLERANCE * size)) note(verdict, "the gradient", way, got, wanted);
        if (verdict->good && way >= forward && way < forward + 3)
            SKG_TRY(compare_forward(run, way, size, verdict));
    }
    return SKG_OK;
}

/* Makes the plan of a self-test, and the gradient that is wanted of it. */
static skg_status find_gradient(skg_context *context, skg_self_test number, const skg_gradient *gradient,
                                gradient_run *run) {
    skg_self_test_scene *scene = &run->scene;
    skg_adjoint adjoint;
    skg_adjoint_init(&adjoint);
    for (int p = 0; p < PIXELS; p++)
        run->adjoint[p] = (double)(p * 7 % 13) - 2; /* sums over rays do not cancel */
    adjoint.channels = 1, adjoint.rows = adjoint.columns = N, adjoint.data = run->adjoint;
    SKG_TRY(skg_self_test_scene_create(context, number, N, scene));
    SKG_TRY(skg_plan_create(context, scene->scene, &scene->view, scene->beam, &scene->options, &run->plan));
    return skg_plan_gradient(run->plan, NULL, &adjoint, gradient);
}

static void release_run(gradient_run **run) {
    skg_plan_release(&(*run)->plan);
    skg_self_test_scene_release(&(*run)->scene);
    skg_free(run);
}

skg_status skg_self_test_gradient(skg_context *context, skg_self_test number, skg_verdict *verdict) {
    gradient_run *run = NULL;
    skg_gradient gradient;
    *verdict = (skg_verdict){.good = 1};
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    skg_gradient_init(&gradient);
    gradient.poses = run->poses[0];
    if (number == SKG_SELF_TEST_GRADIENT) gradient.source = run->source;
    skg_status status = find_gradient(context, number, &gradient, run);
    if (status == SKG_OK) status = compare(run, verdict);
    release_run(&run);
    return status;
}

/* --- by densities */

/* The derivative of a pixel by the density of a part is the part's own attenuation. */
static void compare_density(const gradient_run *run, int part, double got, skg_verdict *verdict) {
    const double shares[SKG_SELF_TEST_ENERGIES_MAX] = {1, 1, 1};
    double wanted = 0, size = 0;
    for (int p = 0; p < PIXELS; p++) {
        double surface, net[2], open;
        skg_self_test_lengths(&run->scene, p / N, p % N, &surface, net);
        net[1 - part] = 0;
        const double shown = skg_self_test_intensity(&run->scene, shares, net, &open);
        wanted -= run->adjoint[p] * log(shown / open);
        size += fabs(run->adjoint[p] * log(shown / open));
    }
    if (!verdict->good || fabs(got - wanted) <= TOLERANCE * size) return;
    verdict->good = 0;
    snprintf(verdict->reason, sizeof verdict->reason,
             "the gradient of %d x %d pixels by the density of the %s is %.7g instead of %.7g", N, N,
             part == 0 ? "boxes" : "box", got, wanted);
}

skg_status skg_self_test_densities(skg_context *context, skg_verdict *verdict) {
    gradient_run *run = NULL;
    skg_gradient gradient;
    double densities[2] = {0};
    *verdict = (skg_verdict){.good = 1};
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    skg_gradient_init(&gradient);
    gradient.densities = densities;
    const skg_status status = find_gradient(context, SKG_SELF_TEST_DENSITIES, &gradient, run);
    for (int part = 0; part < 2 && status == SKG_OK; part++)
        compare_density(run, part, densities[part], verdict);
    release_run(&run);
    return status;
}
