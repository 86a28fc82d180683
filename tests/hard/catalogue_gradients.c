/* Derivatives of drawn scenes: forward against central differences in double precision, reverse against forward, single against double.
 * SKG_GRADIENTS_SEED: other scenes than these; SKG_GRADIENTS_SCENES: how many. */
#include "hard/catalogue.h"

#include "hard/gradients_drawn.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SCENES = 12 };

/* The derivatives of one scene along one direction. slope: by differences; NAN where hits change within their step, or where they differ by what they
 * are of. weights: of the loss. floor: below this a derivative is nothing but rounding */
typedef struct {
    double floor;
    double slope[PIXELS], weights[PIXELS], forward[2][PIXELS], reverse[2];
} found_derivatives;

static void find_slopes(const setting *set, skg_plan *plan, const skg_view *view, const direction *d,
                        found_derivatives *f) {
    static double image[PIXELS];
    static uint8_t marked[PIXELS];
    differentiate(plan, view, d, PIXELS, f->slope);
    drawn_mark_lines(set, view, marked);
    render(plan, view, d, 0, image);
    f->floor = 0;
    for (int p = 0; p < PIXELS; p++) {
        f->floor += 1e-4 * fabs(f->weights[p] * image[p]);
        if (marked[p]) f->slope[p] = (double)NAN;
    }
}

static void find(const setting *set, const direction *d, int32_t precision, found_derivatives *f) {
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, precision, SKG_STRATEGY_AUTO);
    result r;
    allocate(&r);
    if (precision == SKG_PRECISION_DOUBLE) find_slopes(set, plan, &view, d, f);
    make_derivative(plan, d, f->forward[precision]);
    make_gradient(plan, set, f->weights, &r);
    f->reverse[precision] = along(&r, d);
    forget(&r);
    skg_plan_release(&plan);
}

/* The sums of weights times what differs, and of its magnitude, over the pixels that differences are known in. */
static double part_of(const found_derivatives *f, const double *a, const double *b) {
    double sum = 0, size = 0;
    for (int p = 0; p < PIXELS; p++) {
        if (isnan(f->slope[p])) continue;
        sum += f->weights[p] * (a[p] - b[p]);
        size += fabs(f->weights[p] * b[p]);
    }
    return fabs(sum) / fmax(size, f->floor);
}

/* How far the gradient is from the derivative of that precision, over all pixels. */
static double reverse_off(const found_derivatives *f, int precision) {
    double sum = 0, size = 0;
    for (int p = 0; p < PIXELS; p++) {
        sum += f->weights[p] * f->forward[precision][p];
        size += fabs(f->weights[p] * f->forward[precision][p]);
    }
    return fabs(sum - f->reverse[precision]) / fmax(size, f->floor);
}

static void judge(hard_outcome *o, uint64_t number, const char *what, double error, double bar) {
    if (getenv("SKG_GRADIENTS_SCENES"))
        printf("seed %llu: %s off by %.2g\n", (unsigned long long)number, what, error);
    if (!(error <= bar))
        hard_fault(o, "SKG_GRADIENTS_SEED=%llu: %s off by %.2g", (unsigned long long)number, what, error);
}

static void judge_scene(hard_outcome *o, uint64_t number) {
    static found_derivatives f;
    uint64_t seed = 104729 * number;
    const setting set = drawn_make(&seed);
    const direction d = drawn_direction(&set, &seed);
    fill_adjoint(PIXELS, f.weights);
    find(&set, &d, SKG_PRECISION_DOUBLE, &f);
    find(&set, &d, SKG_PRECISION_SINGLE, &f);
    const double right = part_of(&f, f.forward[1], f.slope), single = part_of(&f, f.forward[0], f.forward[1]);
    o->worst[0] = fmax(o->worst[0], single), o->worst[1] = fmax(o->worst[1], right);
    judge(o, number, "the derivative in double", right, o->bar[1]);
    judge(o, number, "the derivative in single", single, o->bar[0]);
    judge(o, number, "the gradient in double", reverse_off(&f, 1), 1e-6);
    judge(o, number, "the gradient in single", reverse_off(&f, 0), 2e-5);
    release_scene();
}

static void drawn(hard_outcome *o) {
    const char *first = getenv("SKG_GRADIENTS_SEED"), *count = getenv("SKG_GRADIENTS_SCENES");
    const uint64_t begin = first ? strtoull(first, NULL, 10) : 1, scenes = count   ? strtoull(count, NULL, 10)
                                                                           : first ? 1
                                                                                   : SCENES;
    o->name = "derivatives of drawn scenes";
    o->danger = "what moves is nested, touches, displaces, or is behind much";
    o->unit = "of the sum";
    o->bar[0] = 1e-3, o->bar[1] = 1e-5; /* a hit may change slightly and pass the test of differences */
    if (!run_has_double()) return;      /* differences are of images in double precision */
    o->worst[0] = o->worst[1] = 0;
    for (uint64_t number = begin; number < begin + scenes; number++) judge_scene(o, number);
}

const hard_function hard_gradients[] = {drawn, NULL};
