/* Drawn scenes of one to three parts, thin and thick, for the bound of the precision. */
#include "support/drawn.h"

#include "support/caster.h"
#include "support/random.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const kinds[] = {"plate", "foil", "rod", "sphere", "blob", "torus", "shell"};

/* A turn about a random axis by Rodrigues' formula, and a place. */
static void place(uint64_t *seed, solid *s) {
    const double z = draw(seed, -1, 1), around = draw(seed, 0, 6.283), across = sqrt(1 - z * z);
    const double a[3] = {across * cos(around), across * sin(around), z}, angle = draw(seed, 0, 6.283);
    const double c = cos(angle), w = sin(angle), d = 1 - c;
    const double m[12] = {c + a[0] * a[0] * d,        a[0] * a[1] * d - a[2] * w, a[0] * a[2] * d + a[1] * w,
                          draw(seed, -40, 40),        a[1] * a[0] * d + a[2] * w, c + a[1] * a[1] * d,
                          a[1] * a[2] * d - a[0] * w, draw(seed, -40, 40),        a[2] * a[0] * d - a[1] * w,
                          a[2] * a[1] * d + a[0] * w, c + a[2] * a[2] * d,        draw(seed, -40, 40)};
    solid_move(s, m);
}

static solid draw_solid(uint64_t *seed, int kind) {
    const double size = pow(10, draw(seed, 0.7, 2.1));
    switch (kind) {
    case 0:
        return solid_box(size * pow(10, draw(seed, -2, 0)), size * draw(seed, 0.3, 1), size);
    case 1:
        return solid_box(pow(10, draw(seed, -2, 0)), size * draw(seed, 0.3, 1), size);
    case 2:
        return solid_box(size * draw(seed, 0.01, 0.1), size * draw(seed, 0.01, 0.1), size);
    case 3:
        return solid_sphere(size / 2, 32, 16);
    case 4:
        return solid_blob(size / 2, 32, 16, draw_bits(seed));
    case 5:
        return solid_torus(0.35 * size, 0.15 * size, 32, 16);
    default:
        return solid_shell(size / 2, size / 2 * draw(seed, 0.6, 0.99), 32, 16);
    }
}

drawn_scene drawn_scene_make(uint64_t number) {
    uint64_t seed = 104729 * number + 11;
    drawn_scene s = {.parts = 1 + (int)draw_below(&seed, DRAWN_PARTS)};
    int used = snprintf(s.name, sizeof s.name, "scene %llu:", (unsigned long long)number);
    for (int p = 0; p < s.parts; p++) {
        const int kind = (int)draw_below(&seed, 7);
        s.solids[p] = draw_solid(&seed, kind);
        place(&seed, &s.solids[p]);
        solid_round(&s.solids[p]);
        s.mu[p] = pow(10, draw(&seed, -1.5, 1));
        used += snprintf(s.name + used, sizeof s.name - (size_t)used, " %s", kinds[kind]);
    }
    skg_view *view = &s.view;
    skg_view_init(view);
    view->projection = number % 3 ? SKG_PROJECTION_POINT : SKG_PROJECTION_PARALLEL;
    view->columns = view->rows = 64;
    view->source[2] = -draw(&seed, 300, 1500);
    view->centre[2] = draw(&seed, 150, 400);
    view->column_step[0] = view->row_step[1] = draw(&seed, 1, 6);
    return s;
}

void drawn_scene_free(drawn_scene *s) {
    for (int p = 0; p < s->parts; p++) solid_free(&s->solids[p]);
}

typedef struct {
    double error;
    int64_t pixel;
} ranked;

static int worst_first(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    return (x->error < y->error) - (x->error > y->error);
}

/* Pixels from the middle of a part's shadow to its rim; a coordinate relative to the part is no larger. */
static double reach_of(const solid *s, const skg_view *view) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int64_t v = 0; v < s->vertices; v++) {
        const double *p = s->positions + 3 * v;
        const double t = view->projection == SKG_PROJECTION_POINT
                             ? (p[2] - view->source[2]) / (view->centre[2] - view->source[2])
                             : 1;
        for (int k = 0; k < 2; k++) {
            const double at = p[k] / (t * view->column_step[0]);
            low[k] = fmin(low[k], at), high[k] = fmax(high[k], at);
        }
    }
    return 1 + 0.5 * fmax(high[0] - low[0], high[1] - low[1]);
}

/* The distance of a transmission from the interval of the shifted rays, relative. */
static double outside(const drawn_scene *s, caster *const *casters, const double *reach, int64_t pixel,
                      double got, double truth) {
    const int64_t columns = s->view.columns;
    double least = 0, most = 0;
    for (int p = 0; p < s->parts; p++) {
        double low = HUGE_VAL, high = -HUGE_VAL, one, other;
        for (int k = 1; k <= 4; k++) { /* last places */
            caster_range(casters[p], &s->view, pixel % columns, pixel / columns,
                         k * (double)FLT_EPSILON * reach[p], &one, &other);
            low = fmin(low, one), high = fmax(high, other);
        }
        least += 0.1 * s->mu[p] * low;
        most += 0.1 * s->mu[p] * high;
    }
    return fmax(0, fmax(exp(-most) - got, got - exp(-least))) / fmax(truth, 1e-6);
}

drawn_error drawn_scene_judge(const drawn_scene *s, const double *single, const double *twice) {
    enum { LIMIT = 300 };
    const int64_t pixels = s->view.rows * s->view.columns;
    drawn_error worst = {0};
    caster *casters[DRAWN_PARTS];
    double reach[DRAWN_PARTS];
    ranked *order = calloc((size_t)pixels, sizeof *order);
    for (int p = 0; p < s->parts; p++) {
        casters[p] = caster_create(&s->solids[p], NULL);
        reach[p] = reach_of(&s->solids[p], &s->view);
    }
    for (int64_t n = 0; n < pixels; n++)
        order[n] = (ranked){fabs(single[n] - twice[n]) / fmax(twice[n], 1e-6), n};
    qsort(order, (size_t)pixels, sizeof *order, worst_first);
    worst.whole = order[0].error;
    for (int64_t n = 0; n < LIMIT && n < pixels && order[n].error > worst.outside; n++) {
        const int64_t pixel = order[n].pixel;
        const double off = outside(s, casters, reach, pixel, single[pixel], twice[pixel]);
        if (off > worst.outside) worst.outside = off, worst.pixel = pixel;
    }
    for (int p = 0; p < s->parts; p++) caster_free(casters[p]);
    free(order);
    return worst;
}
