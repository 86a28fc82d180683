/* Whether a registration finds the spine again: from starts of exactly so many mm and degrees, with radiographs that have more and more
 * of what its model lacks. */
#include "register/subject.h"

#include <skiagraph/registration.h>

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "[--data FOLDER] [--part LABEL] [--kind clean|noise|spectrum|tissue|scatter|hard] [--views N] [--side N] [--shift MM] [--turn DEGREES] "
    "[--trials N] [--first N] [--mesh given|decimated|smoothed] [--restarts N] [--loss lsq|ncc|gradient-ncc] [--polish] [--verbose]";

typedef struct {
    const char *data, *part, *kind_name;
    long views, side, shift, turn, trials, first, restarts, loss;
    int kind, polish, mesh, verbose;
} wishes;

typedef struct {
    double error, cpu, sigma, agreement;
    int verdict;
    int64_t images, jacobians;
} outcome;

static double draw(uint64_t *state) { /* splitmix64: the same starts everywhere */
    uint64_t z = *state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

static void draw_direction(uint64_t *state, double length, double *direction) {
    const double z = 2 * draw(state) - 1, angle = 2 * BENCH_PI * draw(state), across = sqrt(1 - z * z);
    direction[0] = length * across * cos(angle), direction[1] = length * across * sin(angle);
    direction[2] = length * z;
}

/* A twist about the world's origin that turns about the body's middle while the middle moves by the shift, which the turn bends by some
 * thousandths. */
static void draw_start(const wishes *w, const subject *s, long trial, double *twist) {
    uint64_t state = (uint64_t)trial + 1;
    double shift[3];
    draw_direction(&state, (double)w->shift, shift);
    draw_direction(&state, (double)w->turn * BENCH_PI / 180, twist + 3);
    const double *m = s->middle, *r = twist + 3;
    for (int k = 0; k < 3; k++) { /* the velocity of the origin: the axis passes the middle */
        const int l = (k + 1) % 3, n = (k + 2) % 3;
        twist[k] = shift[k] - (r[l] * m[n] - r[n] * m[l]);
    }
}

static void add_radiographs(const wishes *w, const subject *s, double *const *values, skg_registration *r) {
    for (long v = 0; v < w->views; v++) {
        skg_radiograph image;
        skg_radiograph_init(&image);
        image.view = &s->views[v];
        image.values = values[v];
        image.quantity = SKG_QUANTITY_TRANSMISSION;
        bench_try(skg_registration_image_add(r, &image), "radiograph");
    }
}

static outcome run(const wishes *w, const subject *s, double *const *values, long trial) {
    skg_registration_options options;
    skg_registration_result result;
    skg_registration *r;
    const char *verdict;
    skg_registration_options_init(&options);
    options.loss = (int32_t)w->loss, options.polish = w->polish, options.restarts = w->restarts;
    draw_start(w, s, trial, options.start);
    bench_try(skg_registration_create(s->context, s->scene, w->kind & SUBJECT_SPECTRUM ? s->tube : s->mono,
                                      NULL, &options, &r),
              "registration");
    for (int64_t p = 0; p < s->part_count; p++) bench_try(skg_registration_part_add(r, s->parts[p]), "part");
    add_radiographs(w, s, values, r);
    const double begin = bench_now();
    bench_try(skg_registration_run(r), "registration");
    const double ms = bench_now() - begin;
    skg_registration_result_init(&result);
    bench_try(skg_registration_result_get(r, &result), "result");
    bench_try(skg_registration_verdict_get(r, &verdict), "verdict");
    skg_registration_direction worst;
    skg_registration_direction_init(&worst);
    bench_try(skg_registration_direction_get(r, 0, &worst), "direction");
    const outcome found = {.error = subject_error(s, result.twist),
                           .cpu = ms,
                           .sigma = worst.sigma_mm,
                           .agreement = result.agreement,
                           .verdict = result.verdict,
                           .images = result.images,
                           .jacobians = result.jacobians};
    if (w->verbose) {
        int64_t steps;
        printf(
            "%ld: start %.2f mm, error %.4f mm, loss %.4g -> %.4g, residual %.4g noise %.4g over %.3g pixels, explained %.3f, "
            "agreement %.3f, sigma %.2g / %.2g (%s), %lld images, %lld jacobians, %.0f ms, %.1f keV\n    %s\n",
            trial, subject_error(s, options.start), found.error, result.loss_start, result.loss,
            result.residual, result.noise, result.correlation_pixels, result.explained, result.agreement,
            worst.sigma_mm, worst.sigma_structure_mm, worst.name, (long long)result.images,
            (long long)result.jacobians, ms, result.energy_kev, verdict);
        bench_try(skg_registration_step_count(r, &steps), "steps");
        for (int64_t k = 0; k < steps && w->verbose > 1; k++) {
            int64_t level;
            double loss;
            bench_try(skg_registration_step_get(r, k, &level, &loss), "step");
            printf("    level %lld loss %.6g\n", (long long)level, loss);
        }
        fflush(stdout);
    }
    skg_registration_release(&r);
    return found;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(long count, const outcome *all, size_t offset) {
    double *values = bench_alloc((size_t)count, sizeof *values);
    for (long k = 0; k < count; k++) memcpy(&values[k], (const char *)&all[k] + offset, sizeof *values);
    qsort(values, (size_t)count, sizeof *values, ascending);
    const double middle = values[count / 2];
    free(values);
    return middle;
}

static void report(const wishes *w, const outcome *all) {
    int within[4] = {0}, verdicts[6] = {0}, wrong_but_praised = 0;
    const double bars[4] = {0.1, 0.5, 1, 2};
    double images = 0, jacobians = 0, worst = 0;
    for (long k = 0; k < w->trials; k++) {
        for (int b = 0; b < 4; b++) within[b] += all[k].error < bars[b];
        verdicts[all[k].verdict]++;
        wrong_but_praised += all[k].error > 2 && all[k].verdict <= SKG_REGISTRATION_VERDICT_STRUCTURE;
        images += (double)all[k].images / (double)w->trials;
        jacobians += (double)all[k].jacobians / (double)w->trials;
        worst = fmax(worst, all[k].error);
    }
    printf(
        "%s, %ld views, %ld mm and %ld degrees, loss %ld%s, %ld restarts: of %ld under .1 mm %d, .5 mm %d, 1 mm %d, 2 mm %d; median "
        "%.4f mm, worst %.3f mm; %.0f images, %.0f jacobians, %.0f ms; agrees %d, structure %d, not determined %d, failed %d; more "
        "than 2 mm off and not said %d\n",
        w->kind_name, w->views, w->shift, w->turn, w->loss, w->polish ? " polished" : "", w->restarts,
        w->trials, within[0], within[1], within[2], within[3],
        median(w->trials, all, offsetof(outcome, error)), worst, images, jacobians,
        median(w->trials, all, offsetof(outcome, cpu)), verdicts[1], verdicts[2], verdicts[3], verdicts[4],
        wrong_but_praised);
}

static int word_of(const char *value, const char *const *words, int count) {
    for (int k = 0; k < count; k++)
        if (!strcmp(value, words[k])) return k;
    bench_die("%s is none of the words; the first one is %s", value, words[0]);
}

static wishes read_wishes(int count, char **words) {
    static const char *const kinds[] = {"clean", "noise", "spectrum", "tissue", "scatter", "hard"};
    static const int bits[] = {0,
                               SUBJECT_NOISE,
                               SUBJECT_NOISE | SUBJECT_SPECTRUM,
                               SUBJECT_NOISE | SUBJECT_TISSUE,
                               SUBJECT_NOISE | SUBJECT_SCATTER,
                               SUBJECT_NOISE | SUBJECT_SPECTRUM | SUBJECT_TISSUE | SUBJECT_SCATTER};
    static const char *const losses[] = {"lsq", "ncc", "gradient-ncc"};
    static const char *const meshes[] = {"given", "decimated", "smoothed"};
    wishes w = {.kind_name = "clean", .views = 2, .side = 256, .shift = 10, .turn = 10, .trials = 20};
    bench_arguments arguments = {count, words, 1};
    const char *value;
    const struct {
        const char *name;
        long *number;
    } numbers[] = {{"--views", &w.views},      {"--side", &w.side},     {"--shift", &w.shift},
                   {"--turn", &w.turn},        {"--trials", &w.trials}, {"--first", &w.first},
                   {"--restarts", &w.restarts}};
    while (arguments.next < count) {
        int known = 0;
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers && !known; k++) {
            known = bench_option(&arguments, numbers[k].name, &value);
            if (known) bench_numbers(value, 0, 100000, 1, numbers[k].number);
        }
        if (known) continue;
        if (bench_option(&arguments, "--data", &w.data)) continue;
        if (bench_option(&arguments, "--part", &w.part)) continue;
        if (bench_option(&arguments, "--kind", &value)) {
            w.kind_name = value;
            w.kind = bits[word_of(value, kinds, 6)];
        } else if (bench_option(&arguments, "--loss", &value)) {
            w.loss = word_of(value, losses, 3);
        } else if (bench_option(&arguments, "--mesh", &value)) {
            w.mesh = word_of(value, meshes, 3);
        } else if (bench_flag(&arguments, "--polish")) {
            w.polish = 1;
        } else if (bench_flag(&arguments, "--verbose")) {
            w.verbose++;
        } else {
            bench_usage(&arguments, usage);
        }
    }
    if (w.views < 1 || w.views > SUBJECT_VIEWS || w.trials < 1) bench_usage(&arguments, usage);
    return w;
}

int main(int count, char **words) {
    const wishes w = read_wishes(count, words);
    subject s;
    double *values[SUBJECT_VIEWS] = {NULL};
    outcome *all = bench_alloc((size_t)w.trials, sizeof *all);
    subject_make(w.data, w.part, w.side, &s);
    for (long v = 0; v < w.views; v++) values[v] = subject_radiograph(&s, (int)v, w.kind);
    if (w.mesh != SUBJECT_AS_GIVEN) subject_segment(&s, w.mesh);
    for (long k = 0; k < w.trials; k++) all[k] = run(&w, &s, values, w.first + k);
    report(&w, all);
    for (int v = 0; v < SUBJECT_VIEWS; v++) free(values[v]);
    subject_free(&s);
    free(all);
    return 0;
}
