/* Images of scatter against those of a Monte Carlo program. */
#include "scatter/compare.h"

#include "../tests/scatter/sums.h"
#include "mc/reference.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Pixels along a side, of which the middle half is compared; blocks of pixels; g/cm3 that gives the reference's attenuation of
 * .20554967/cm. */
enum { SIDE = 32, PIXELS = SIDE * SIDE, BLOCK = 4, ROW = SIDE / BLOCK, BLOCKS = ROW * ROW };
static const double THEIR_PER_CM = 0.20554967;

/* Parts of the comparison: planes of sums (a bit for each), the reference's file, and the bar of the middle in %; 0: none. */
typedef struct {
    const char *name, *file;
    unsigned planes;
    double bar;
} part;

static const part parts[] = {
    {"once, Rayleigh", "scatter_order1_rayleigh", 1u << 0, 1},
    {"once, Compton", "scatter_order1_compton", 1u << 3, 1},
    {"once", "scatter_order1", 1u << 0 | 1u << 3, 1},
    {"twice", "scatter_order2", 1u << 1 | 1u << 4, 1},
    {"more often", "scatter_higher", 1u << 2 | 1u << 5, 1},
    {"all", "scatter", (1u << SUMS_KINDS) - 1, 0.8},
};
enum { PARTS = sizeof parts / sizeof *parts };

static double sum_of(const taken *t, unsigned planes, int64_t batch, int64_t place) {
    double sum = 0;
    for (int p = 0; p < SUMS_KINDS; p++)
        if (planes >> p & 1) sum += (double)t->sums[(batch * SUMS_PLANES + p) * t->places + place];
    return sum;
}

static int is_middle(int64_t i) {
    const int64_t row = i / SIDE, column = i % SIDE;
    return row >= SIDE / 4 && row < 3 * SIDE / 4 && column >= SIDE / 4 && column < 3 * SIDE / 4;
}

/* A sum over some pixels, with its error: of the batches, and of the reference. */
typedef struct {
    double ours, our_sigma, theirs, their_sigma;
} figure;

/* Which pixels: those of a block, or the middle half if block is -1. */
static figure find_figure(const taken *t, unsigned planes, double unit, const double *theirs,
                          const double *sigma, int64_t block) {
    double batches[SUMS_BATCHES] = {0}, square = 0;
    figure f = {0};
    for (int64_t i = 0; i < PIXELS; i++) {
        if (block < 0 ? !is_middle(i) : i / SIDE / BLOCK * ROW + i % SIDE / BLOCK != block) continue;
        for (int64_t b = 0; b < SUMS_BATCHES; b++) batches[b] += unit * sum_of(t, planes, b, i);
        f.theirs += theirs[i];
        square += sigma[i] * sigma[i];
    }
    for (int64_t b = 0; b < SUMS_BATCHES; b++) f.ours += batches[b];
    for (int64_t b = 0; b < SUMS_BATCHES; b++) f.our_sigma += pow(batches[b] - f.ours / SUMS_BATCHES, 2);
    f.our_sigma = sqrt(f.our_sigma * SUMS_BATCHES / (SUMS_BATCHES - 1.0));
    f.their_sigma = sqrt(square);
    return f;
}

/* From sums to keV of a pixel for each photon that the source sends anywhere. */
static double unit_of(const subject *s, const taken *t) {
    const double far = s->view.centre[0] - s->view.source[0], pitch = s->view.column_step[1];
    double image = 0, sums = 0;
    for (int64_t i = 0; i < PIXELS; i++) {
        image += t->scatter[i];
        for (int64_t b = 0; b < SUMS_BATCHES; b++) sums += sum_of(t, (1u << SUMS_KINDS) - 1, b, i);
    }
    return image / sums * pitch * pitch / (4 * BENCH_PI * far * far);
}

static int compare_part(const char *prefix, const char *name, const part *p, const taken *t, double unit,
                        int exact, FILE *csv) {
    char file[128];
    int above = 0;
    double worst = 0;
    double *theirs = reference_read(prefix, p->file, SIDE, SIDE, 1);
    snprintf(file, sizeof file, "%s_sigma", p->file);
    double *sigma = reference_read(prefix, file, SIDE, SIDE, 1);
    const figure f = find_figure(t, p->planes, unit, theirs, sigma, -1);
    for (int64_t b = 0; b < BLOCKS; b++) {
        const figure g = find_figure(t, p->planes, unit, theirs, sigma, b);
        const double off = fabs(g.ours - g.theirs) / hypot(g.our_sigma, g.their_sigma);
        worst = fmax(worst, off);
        above += off > 3;
    }
    const double off = 100 * (f.ours / f.theirs - 1);
    const double error = 100 * hypot(f.our_sigma / f.ours, f.their_sigma / f.theirs);
    const int missed = exact && (!(fabs(off) <= p->bar) || !(worst <= 4.5));
    printf("| %s, %s | %s | %+.2f | %.2f | %.1f | %d | %s |\n", name, exact ? "their attenuation" : "ours",
           p->name, off, error, worst, above,
           !exact   ? ""
           : missed ? "MISSED"
                    : "met");
    if (csv)
        fprintf(csv, "%s,\"%s %s\",%.4g,%.3g,%.3g,%d,%g\n", name, p->name, exact ? "theirs" : "ours", off,
                error, worst, above, exact ? p->bar : 0);
    free(theirs);
    free(sigma);
    return missed;
}

static int compare_slab(skg_context *context, const char *name, const char *prefix, double plane,
                        int64_t histories, int exact, FILE *csv) {
    char path[4096];
    int missed = 0;
    skg_material *water = NULL;
    double per_cm = 0, density = 0;
    bench_try(skg_material_create_named("Water, Liquid", &water), "water");
    bench_try(skg_material_attenuation_get(water, 60, &per_cm), "water");
    bench_try(skg_material_density_get(water, &density), "water");
    skg_material_release(&water);
    subject s = subject_water(context, name, plane, exact ? density * THEIR_PER_CM / per_cm : density);
    taken t = subject_take(&s, 0, histories, 1);
    snprintf(path, sizeof path, "%s%s_", prefix, name);
    for (int k = exact ? 0 : PARTS - 1; k < PARTS; k++)
        missed += compare_part(path, name, &parts[k], &t, unit_of(&s, &t), exact, csv);
    taken_free(&t);
    subject_close(&s);
    return missed;
}

int compare_water(skg_context *context, const char *prefix, int64_t histories, FILE *csv) {
    int missed = 0;
    printf(
        "20 cm of water at 60 keV, %" PRId64
        " histories, before smoothing; w0: the detector on the slab, w1: 20 cm behind "
        "it. Blocks of 4 x 4 pixels, 64 of them.\n\n"
        "| slab | interactions | middle half off by, %% | standard error, %% | worst block, sigma | blocks above 3 | "
        "bar: middle 1 %% (all: .8 %%), blocks 4.5 |\n|---|---|---|---|---|---|---|\n",
        histories);
    for (int exact = 1; exact >= 0; exact--) {
        missed += compare_slab(context, "w0", prefix, 100.00001, histories, exact, csv);
        missed += compare_slab(context, "w1", prefix, 300, histories, exact, csv);
    }
    printf("\n");
    return missed;
}

/* --- the cube --- */

enum { CUBE_SIDE = 301, CUBE_BLOCK = 20, CUBE_ROW = 15 };

/* The mean of a block, and the standard error of the mean from the scatter of its pixels around a plane. */
static void judge_block(const double *image, int64_t block, double *mean, double *error) {
    const int64_t row = block / CUBE_ROW * CUBE_BLOCK, column = block % CUBE_ROW * CUBE_BLOCK;
    const double n = CUBE_BLOCK * CUBE_BLOCK, spread = n * (CUBE_BLOCK * CUBE_BLOCK - 1) / 12.0;
    double sum = 0, along[2] = {0}, square = 0;
    for (int64_t i = 0; i < CUBE_BLOCK * CUBE_BLOCK; i++) {
        const double x = (double)(i % CUBE_BLOCK) - 9.5, y = (double)(i / CUBE_BLOCK) - 9.5;
        const double value = image[(row + i / CUBE_BLOCK) * CUBE_SIDE + column + i % CUBE_BLOCK];
        sum += value, along[0] += value * x, along[1] += value * y;
        square += value * value;
    }
    *mean = sum / n;
    square -= sum * sum / n + (along[0] * along[0] + along[1] * along[1]) / spread;
    *error = sqrt(fmax(square, 0) / (n - 3) / n);
}

int compare_cube(skg_context *context, const char *prefix, const char *scene, double tolerance, FILE *csv) {
    double *theirs = reference_read(prefix, "scatter", CUBE_SIDE, CUBE_SIDE, 1);
    int missed = 0;
    printf(
        "A cube of 3 cm of soft tissue with a cylinder of bone, 80 keV, to %g %%. 225 blocks of 20 x 20 pixels.\n\n"
        "| attenuation | mean off by, %% | worst block, sigma of both | blocks above 3 | with equal means | bar: .8 %%, 4.5, "
        "3 blocks |\n|---|---|---|---|---|---|\n",
        100 * tolerance);
    for (int exact = 1; exact >= 0; exact--) {
        subject s = subject_cube(context, scene, exact);
        taken t = subject_take(&s, tolerance, 0, 1);
        const double far = s.view.centre[0] - s.view.source[0], pitch = s.view.column_step[1];
        const double unit = pitch * pitch / (4 * BENCH_PI * far * far);
        double ours = 0, all = 0, worst = 0;
        int above = 0,
            matched = 0; /* beyond 3 sigma: as they are, and after the means of both are made equal */
        for (int64_t i = 0; i < t.count; i++) ours += unit * t.scatter[i], all += theirs[i];
        for (int64_t b = 0; b < CUBE_ROW * CUBE_ROW; b++) {
            double own, own_error, other, other_error, sigma, rest;
            judge_block(t.scatter, b, &own, &own_error);
            judge_block(t.sigma, b, &sigma, &rest);
            judge_block(theirs, b, &other, &other_error);
            const double off = fabs(unit * own - other) / hypot(unit * sigma, other_error);
            worst = fmax(worst, off);
            above += off > 3;
            matched += fabs(unit * own * all / ours - other) / hypot(unit * sigma, other_error) > 3;
        }
        const double off = 100 * (ours / all - 1);
        const int miss = exact && (!(fabs(off) <= 0.8) || !(worst <= 4.5) || above > 3);
        printf("| %s | %+.2f | %.1f | %d | %d | %s |\n", exact ? "theirs" : "ours", off, worst, above,
               matched,
               !exact ? ""
               : miss ? "MISSED"
                      : "met");
        if (csv)
            fprintf(csv, "a,\"all %s\",%.4g,%.3g,%.3g,%d,%g\n", exact ? "theirs" : "ours", off,
                    100 * t.report.sigma / t.report.mean, worst, above, exact ? 0.8 : 0);
        missed += miss;
        taken_free(&t);
        subject_close(&s);
    }
    printf("\n");
    free(theirs);
    return missed;
}
