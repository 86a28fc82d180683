/* 2D/3D registration: where does a part of a scene stand, if only its image is known? The part is moved, its image is kept,
 * and the translation is found again from a start some mm away. Each step makes the images of the current pose and of one
 * shifted pose for each axis in one batch, and solves the linear least squares problem (Gauss and Newton).
 *
 *     cc registration.c $(pkg-config --cflags --libs skiagraph) -lm -o registration
 *     ./registration phantom.json marker */
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AXES = 2, FRAMES = AXES + 1, STEPS = 12 };
static const int axes[AXES] = {0, 2}; /* x and z: y is along the rays of the example */
static const double truth[AXES] = {4, -3}, start[AXES] = {0, 0}, shift = 1; /* mm */

typedef struct {
    skg_plan *plan;
    int64_t part, pixels;
    double pose[16];        /* of the file */
    float *images, *wanted; /* [FRAMES][pixels], [pixels] */
} problem;

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "%s: %s\n", skg_status_name(status), skg_last_error());
    return SKG_FAILED(status) || status == SKG_STALE; /* after SKG_RANGE the image is there */
}

/* Images with the part moved by each of these translations. */
static int render(const problem *p, int count, const double (*moved)[AXES], float *images) {
    skg_frame frames[FRAMES];
    double poses[FRAMES][16];
    skg_output output;
    skg_job *job = NULL;
    for (int n = 0; n < count; n++) {
        memcpy(poses[n], p->pose, sizeof poses[n]);
        for (int k = 0; k < AXES; k++) poses[n][4 * axes[k] + 3] += moved[n][k];
        skg_frame_init(&frames[n]);
        frames[n].pose_count = 1;
        frames[n].pose_parts = &p->part;
        frames[n].poses = poses[n];
    }
    skg_output_init(&output);
    output.data = images;
    return failed(skg_plan_submit(p->plan, count, frames, 1, &output, &job)) || failed(skg_job_wait(&job));
}

/* Solves a x = b in place by elimination. */
static void solve(double a[AXES][AXES], double b[AXES]) {
    for (int k = 0; k < AXES; k++)
        for (int r = k + 1; r < AXES; r++) {
            const double factor = a[r][k] / a[k][k];
            for (int c = k; c < AXES; c++) a[r][c] -= factor * a[k][c];
            b[r] -= factor * b[k];
        }
    for (int k = AXES - 1; k >= 0; k--) {
        for (int c = k + 1; c < AXES; c++) b[k] -= a[k][c] * b[c];
        b[k] /= a[k][k];
    }
}

/* One step: the change of the translation that brings the image nearer to the wanted one, and the error before. */
static int step(const problem *p, double at[AXES], double *error) {
    double moved[FRAMES][AXES], a[AXES][AXES] = {{0}}, b[AXES] = {0};
    for (int n = 0; n < FRAMES; n++) {
        memcpy(moved[n], at, sizeof moved[n]);
        if (n > 0) moved[n][n - 1] += shift;
    }
    if (render(p, FRAMES, (const double(*)[AXES])moved, p->images)) return 1;
    *error = 0;
    for (int64_t i = 0; i < p->pixels; i++) {
        const double now = (double)p->images[i], off = (double)p->wanted[i] - now;
        double slope[AXES];
        for (int k = 0; k < AXES; k++) slope[k] = ((double)p->images[(k + 1) * p->pixels + i] - now) / shift;
        for (int k = 0; k < AXES; k++) {
            for (int c = 0; c < AXES; c++) a[k][c] += slope[k] * slope[c];
            b[k] += slope[k] * off;
        }
        *error += off * off;
    }
    solve(a, b);
    for (int k = 0; k < AXES; k++)
        at[k] += fmax(-2, fmin(2, b[k])); /* the image is linear over a few pixels only */
    return 0;
}

static int run(problem *p) {
    double at[AXES], error = 0;
    const double known[1][AXES] = {{truth[0], truth[1]}};
    memcpy(at, start, sizeof at);
    if (render(p, 1, known, p->wanted)) return 1;
    for (int n = 0; n < STEPS; n++) {
        if (step(p, at, &error)) return 1;
        printf("step %2d: error %.3e, then (%.3f, %.3f) mm\n", n, sqrt(error), at[0], at[1]);
    }
    const double miss = hypot(at[0] - truth[0], at[1] - truth[1]);
    printf("missed by %.3f mm\n", miss);
    return miss > 0.1;
}

int main(int count, char **words) {
    problem p = {0};
    skg_context *context = NULL;
    skg_setup *setup = NULL;
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    skg_view view;
    skg_plan_options options;
    skg_part part;
    if (count != 3) {
        fprintf(stderr, "usage: registration SCENE LABEL\n");
        return 2;
    }
    skg_view_init(&view);
    skg_part_init(&part);
    skg_plan_options_init(&options);
    int bad = failed(skg_context_create(NULL, &context)) ||
              failed(skg_setup_load(context, words[1], 0, NULL, &setup)) ||
              failed(skg_setup_scene_get(setup, &scene)) ||
              failed(skg_setup_spectrum_get(setup, &spectrum)) || failed(skg_setup_view_get(setup, &view)) ||
              failed(skg_setup_options_get(setup, &options));
    options.quantity = SKG_QUANTITY_ATTENUATION;
    bad = bad || failed(skg_scene_part_find(scene, words[2], &p.part)) ||
          failed(skg_scene_part_get(scene, p.part, &part)) ||
          failed(skg_plan_create(context, scene, &view, spectrum, &options, &p.plan));
    if (!bad) {
        memcpy(p.pose, part.pose, sizeof p.pose);
        p.pixels = view.columns * view.rows;
        p.images = calloc((size_t)(p.pixels * FRAMES), sizeof *p.images);
        p.wanted = calloc((size_t)p.pixels, sizeof *p.wanted);
        bad = !p.images || !p.wanted || run(&p);
    }
    free(p.images);
    free(p.wanted);
    skg_plan_release(&p.plan);
    skg_setup_release(&setup);
    skg_context_release(&context);
    return bad;
}
