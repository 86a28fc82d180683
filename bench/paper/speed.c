/* Frames a second of the paper's scene, by precision and repair. */
#include "paper/speed.h"
#include "common/thorax.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A way to make the image. Half requires closed meshes. */
typedef struct {
    const char *name;
    int32_t precision, leaky, repair;
} way;

static const way ways[] = {
    {"half; closed", SKG_PRECISION_HALF, THORAX_CLOSED, 0},
    {"single; closed", SKG_PRECISION_SINGLE, THORAX_CLOSED, 0},
    {"double; closed", SKG_PRECISION_DOUBLE, THORAX_CLOSED, 0},
    {"single; liver open; none", SKG_PRECISION_SINGLE, THORAX_LEAKY_LIVER, SKG_REPAIR_NONE},
    {"single; liver open; neighbours", SKG_PRECISION_SINGLE, THORAX_LEAKY_LIVER, SKG_REPAIR_NEIGHBOURS},
    {"single; liver open; exact", SKG_PRECISION_SINGLE, THORAX_LEAKY_LIVER, SKG_REPAIR_EXACT},
    {"single; all open; neighbours", SKG_PRECISION_SINGLE, THORAX_ALL_LEAKY, SKG_REPAIR_NEIGHBOURS},
};
enum { WAYS = sizeof ways / sizeof *ways, WAY_SINGLE = 1, WAY_DOUBLE = 2, WAY_ALL_LEAKY = 6, PILOT = 3 };

/* Something that is timed in turns with others. */
typedef struct {
    const char *name;
    bench_frame frame;
    void *what;
    long images;       /* in each value */
    bench_times rates; /* the values: images per second instead of ms */
} contender;

typedef struct {
    skg_plan *plan; /* NULL: the device lacks this precision */
    skg_output output;
    double worst, rms; /* (I - I of double; closed) / I0 */
    int64_t bad, repaired;
} picture;

static void take(void *what) {
    picture *p = what;
    bench_try(skg_plan_image(p->plan, &p->output), "image");
}

/* Chooses the number of images in a value such that the point takes no more than its time. */
static void allot(const paper_study *study, contender *c) {
    c->frame(c->what);
    const double start = bench_now();
    for (int i = 0; i < PILOT; i++) c->frame(c->what);
    const double each = (bench_now() - start) / PILOT;
    c->images = (long)(1e3 * (double)study->seconds / (each * (double)study->series));
    if (c->images > study->iterations) c->images = study->iterations;
    if (c->images < 1) c->images = 1;
}

/* Times the contenders in turn, one value each, until every one has all its values. */
static void race(const paper_study *study, int count, contender *all) {
    for (int i = 0; i < count; i++) allot(study, &all[i]);
    for (long turn = 0; turn < study->series; turn++) {
        for (int i = 0; i < count; i++) {
            contender *c = &all[i];
            bench_sleep(10);
            c->frame(c->what);
            const double start = bench_now();
            for (long k = 0; k < c->images; k++) c->frame(c->what);
            bench_add(&c->rates, 1e3 * (double)c->images / (bench_now() - start));
        }
    }
}

static double greatest(const bench_times *rates) {
    double most = rates->ms[0];
    for (int i = 1; i < rates->count; i++) most = fmax(most, rates->ms[i]);
    return most;
}

static void write_rates(const paper_study *study, const char *part, const contender *c, int64_t triangles,
                        const char *unit) {
    for (int i = 0; i < c->rates.count; i++)
        paper_row(study, part, c->name, triangles, i + 1, c->rates.ms[i], unit);
}

/* --- still --- */

static skg_plan *plan_of(const paper_study *study, const bench_thorax *thorax, const way *w) {
    skg_scene *scene = thorax_scene(study->context, thorax);
    skg_spectrum *beam = thorax_beam();
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_view view;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = w->precision;
    options.repair = w->repair;
    thorax_view(study->size, &view);
    const skg_status status = skg_plan_create(study->context, scene, &view, beam, &options, &plan);
    if (status == SKG_ERR_UNSUPPORTED)
        fprintf(stderr, "%s: left out: %s\n", w->name, skg_last_error());
    else
        bench_try(status, w->name);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    return plan;
}

static void open_picture(const paper_study *study, const bench_thorax *thorax, const way *w, picture *out) {
    out->plan = plan_of(study, thorax, w);
    skg_output_init(&out->output);
    out->output.data = bench_alloc((size_t)(study->size * study->size), sizeof(float));
}

static void close_picture(picture *p) {
    skg_plan_release(&p->plan);
    free(p->output.data);
}

/* Differences from the reference picture, as fractions of the flat field. */
static void find_errors(const paper_study *study, const picture *reference, picture *p) {
    const float *ours = p->output.data, *truth = reference->output.data;
    const int64_t count = study->size * study->size;
    skg_channel channel;
    skg_plan_report report;
    skg_channel_init(&channel);
    skg_plan_report_init(&report);
    bench_try(skg_plan_channel_get(p->plan, 0, &channel), "plan");
    bench_try(skg_plan_report_get(p->plan, &report), "plan");
    p->worst = p->rms = 0;
    for (int64_t i = 0; i < count; i++) {
        const double error = ((double)ours[i] - (double)truth[i]) / channel.flat_field;
        p->worst = fmax(p->worst, fabs(error));
        p->rms += error * error / (double)count;
    }
    p->rms = sqrt(p->rms);
    p->bad = report.bad_pixels, p->repaired = report.repaired_pixels;
}

/* base: the contender whose median the others' are divided by. */
static void print_picture(const paper_study *study, const contender *c, const contender *base,
                          int64_t triangles) {
    const picture *p = c->what;
    printf("| %" PRId64 " | %s | %ld x %ld | %.4g | %.4g to %.4g | %.2f | ", triangles, c->name,
           study->series, c->images, bench_median(&c->rates), bench_min(&c->rates), greatest(&c->rates),
           bench_median(&c->rates) / bench_median(&base->rates));
    if (isnan(p->worst))
        printf("- | - | ");
    else
        printf("%.2g | %.2g | ", p->worst, p->rms);
    printf("%" PRId64 " / %" PRId64 " |\n", p->bad, p->repaired);
    write_rates(study, "images", c, triangles, "1/s");
    if (isnan(p->worst)) return;
    paper_row(study, "worst error", c->name, triangles, 0, p->worst, "of the open beam");
    paper_row(study, "rms error", c->name, triangles, 0, p->rms, "of the open beam");
}

static void still(const paper_study *study, long triangles) {
    bench_thorax thorax[THORAX_ALL_LEAKY + 1];
    picture *pictures = bench_alloc(WAYS, sizeof *pictures);
    contender *all = bench_alloc(WAYS, sizeof *all);
    int count = 0;
    for (int leaky = 0; leaky <= THORAX_ALL_LEAKY; leaky++) thorax_make(triangles, leaky, &thorax[leaky]);
    for (int k = 0; k < WAYS; k++) {
        open_picture(study, &thorax[ways[k].leaky], &ways[k], &pictures[k]);
        if (!pictures[k].plan) continue;
        all[count++] = (contender){.name = ways[k].name, .frame = take, .what = &pictures[k]};
    }
    race(study, count, all);
    for (int k = 0; k < count; k++) {
        picture *p = all[k].what;
        p->worst = p->rms = nan("");
        if (pictures[WAY_DOUBLE].plan) find_errors(study, &pictures[WAY_DOUBLE], p);
        print_picture(study, &all[k], &all[WAY_SINGLE], thorax[0].triangles);
    }
    for (int k = 0; k < WAYS; k++) close_picture(&pictures[k]);
    for (int leaky = 0; leaky <= THORAX_ALL_LEAKY; leaky++) thorax_free(&thorax[leaky]);
    free(all);
    free(pictures);
}

/* --- breathing --- */

typedef struct {
    picture picture; /* its plan is NULL if no image is made */
    skg_body *body;
    skg_job *job;
    int64_t step;
} fluoroscope;

/* Computes the next pose while the device makes the image of the last one. */
static void breathe(void *what) {
    enum { STEPS = 120 }; /* of a breath */
    fluoroscope *f = what;
    skg_breath breath;
    skg_breath_state state;
    skg_breath_init(&breath);
    skg_breath_state_init(&state);
    if (f->job) bench_try(skg_job_wait(&f->job), "image");
    if (f->picture.plan)
        bench_try(skg_plan_submit(f->picture.plan, 1, NULL, 1, &f->picture.output, &f->job), "image");
    bench_try(skg_breath_state_at_phase(&breath, (double)(f->step++ % STEPS) / STEPS, &state), "breath");
    bench_try(skg_body_pose(f->body, &state), "body");
}

static void breathing(const paper_study *study) {
    /* printed: the paper's range. Its images are corrected, which closed meshes do not need. */
    static const struct {
        const char *name, *unit;
        int way; /* -1: no image */
        double printed[2];
    } rows[] = {{"breathing alone", "steps/s", -1, {221, 718}},
                {"breathing and image; closed", "images/s", WAY_SINGLE, {13, 101}},
                {"breathing and image; all open; neighbours", "images/s", WAY_ALL_LEAKY, {13, 101}}};
    enum { ROWS = sizeof rows / sizeof *rows };
    bench_thorax thorax[ROWS];
    fluoroscope *f = bench_alloc(ROWS, sizeof *f);
    contender *all = bench_alloc(ROWS, sizeof *all);
    for (int k = 0; k < ROWS; k++) {
        const way *w = rows[k].way < 0 ? NULL : &ways[rows[k].way];
        thorax_make(study->body, w ? w->leaky : THORAX_CLOSED, &thorax[k]);
        f[k].body = thorax_body(&thorax[k]);
        if (w) open_picture(study, &thorax[k], w, &f[k].picture);
        all[k] = (contender){.name = rows[k].name, .frame = breathe, .what = &f[k]};
    }
    race(study, ROWS, all);
    printf(
        "\n## A thorax that breathes\n\n%" PRId64
        " triangles, single precision. Printed: the paper's figures for 41,710 triangles on its own computers, images with correction.\n\n"
        "| what | values | unit | median | least to most | printed |\n|---|---:|---|---:|---:|---:|\n",
        thorax[0].triangles);
    for (int k = 0; k < ROWS; k++) {
        printf("| %s | %ld x %ld | %s | %.4g | %.4g to %.4g | %g to %g |\n", rows[k].name, study->series,
               all[k].images, rows[k].unit, bench_median(&all[k].rates), bench_min(&all[k].rates),
               greatest(&all[k].rates), rows[k].printed[0], rows[k].printed[1]);
        write_rates(study, "breathing", &all[k], thorax[k].triangles, rows[k].unit);
    }
    for (int k = 0; k < ROWS; k++) {
        if (f[k].job) bench_try(skg_job_wait(&f[k].job), "image");
        skg_body_release(&f[k].body);
        close_picture(&f[k].picture);
        thorax_free(&thorax[k]);
    }
    free(all);
    free(f);
}

void paper_speed(const paper_study *study) {
    printf(
        "\n## Fig. 17, 18 and Table 5: half, single and double, with and without correction\n\n"
        "The generated thorax, not moving, %ld x %ld pixels, five materials, ten energies. A time runs from the submission to the image "
        "in host memory. An open mesh lacks every hundredth triangle; half requires closed meshes. The column of values gives their "
        "number, and the number of images in each. Errors are differences from the image of double; closed, as fractions of the "
        "flat field. The last column: bad pixels of all meshes / pixels that were repaired.\n\n"
        "| triangles | precision; meshes; correction | values | images/s, median | least to most | of single; closed | worst error | rms error | bad / repaired |\n"
        "|---:|---|---:|---:|---:|---:|---:|---:|---:|\n",
        study->size, study->size);
    for (int i = 0; i < study->sizes; i++) still(study, study->triangles[i]);
    breathing(study);
}
