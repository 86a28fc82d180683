/* Fits the calibration of the tube (lib/beam/calibration.c) to spectra (spectra.py), by least squares of logarithms, and prints
 * it as C. The fit starts at the calibration in use, so that --rounds 0 compares that one with the spectra. */
#include "beam/spectrum.h"
#include "common/bench.h"
#include "material/material.h"
#include "material/shells.h"
#include "spectral/compression.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] = "--spectra FILE.csv [--rounds N]";

enum { CONTINUUM, K_LINES, L_LINES, KINDS, FACTORS_MAX = 16, LINE_FACTORS = 5 };

typedef struct {
    skg_anode anode;
    int kind;
    double kev, photons, weight;
} sample;

typedef struct {
    sample *all;
    int64_t count;
} samples;

/* Target of a fit: the samples of one anode and kind, and for the continuum the model. */
typedef struct {
    const samples *from;
    int32_t z, kind, model, high; /* high: 1: the factors above the seam, from voltages above it */
} target;

static samples read_samples(const char *path) {
    static const char *const names[KINDS] = {"continuum", "K", "L"};
    samples out = {0};
    char line[256];
    FILE *file = fopen(path, "r");
    if (!file) bench_die("%s: cannot be opened", path);
    while (fgets(line, sizeof line, file)) {
        sample s = {.kind = -1, .weight = 1};
        char kind[16];
        if (sscanf(line, "%" SCNd32 ",%lf,%lf,%15[^,],%lf,%lf", &s.anode.z, &s.anode.kvp, &s.anode.angle_deg,
                   kind, &s.kev, &s.photons) != 6)
            continue;
        for (int k = 0; k < KINDS; k++)
            if (strcmp(kind, names[k]) == 0) s.kind = k;
        if (s.kind < 0) bench_die("%s: %s is not known; rows are of continuum, K or L", path, kind);
        if (out.count % 1024 == 0) {
            out.all = realloc(out.all, ((size_t)out.count + 1024) * sizeof *out.all);
            if (!out.all) bench_die("out of memory");
        }
        out.all[out.count++] = s;
    }
    fclose(file);
    return out;
}

static int is_same(const skg_anode *a, const skg_anode *b) {
    return a->z == b->z && a->kvp == b->kvp && a->angle_deg == b->angle_deg;
}

/* Weights each energy of a continuum by its share of the air kerma behind two filters, or above the seam three, in equal parts. */
enum { FILTERS = 3 };

static void weigh(samples *s) {
    skg_material *aluminium = NULL, *copper = NULL;
    bench_try(skg_material_create_element(13, &aluminium), "aluminium");
    bench_try(skg_material_create_element(29, &copper), "copper");
    const skg_filter low[FILTERS] = {{sizeof *low, 0, aluminium, 0.5}, {sizeof *low, 0, aluminium, 2.5}},
                     high[FILTERS] = {{sizeof *low, 0, aluminium, 2.5},
                                      {sizeof *low, 0, copper, 0.5},
                                      {sizeof *low, 0, copper, 2}};
    for (int64_t first = 0, next; first < s->count; first = next) {
        const int is_high =
            s->all[first].anode.kvp > skg_tube_calibration_of(s->all[first].anode.z)->seam_kvp;
        const int filters = is_high ? FILTERS : FILTERS - 1;
        double whole[FILTERS] = {0}, share[FILTERS];
        for (int pass = 0; pass < 2; pass++)
            for (next = first; next < s->count && is_same(&s->all[next].anode, &s->all[first].anode);
                 next++) {
                sample *at = s->all + next;
                if (at->kind != CONTINUUM) continue;
                if (pass == 1) at->weight = 0;
                for (int f = 0; f < filters; f++) {
                    bench_try(skg_filters_pass(1, (is_high ? high : low) + f, at->kev, &share[f]), "filter");
                    share[f] *= at->photons * skg_air_kerma(at->kev);
                    if (pass == 0) whole[f] += share[f];
                    if (pass == 1) at->weight += share[f] / whole[f] / filters;
                }
            }
    }
    skg_material_release(&copper);
    skg_material_release(&aluminium);
}

/* The factors of a target within its calibration: `count` places. */
static int places(const target *t, skg_tube_calibration *c, double **place) {
    int count = 0;
    if (t->high && t->kind == K_LINES) {
        for (int i = 0; i < 3; i++) place[count++] = c->k_high + i;
        return count;
    }
    for (int i = 0; i < 4 && t->high; i++)
        for (int j = 0; j < 2; j++) place[count++] = c->continuum[t->model].h[i] + j;
    for (int i = 0; i < 2 && t->high; i++) place[count++] = c->continuum[t->model].g + i;
    if (t->high) return count;
    if (t->kind != CONTINUUM) {
        for (int i = 0; i < LINE_FACTORS; i++) place[count++] = (t->kind == K_LINES ? c->k : c->l) + i;
        return count;
    }
    skg_continuum_factors *f = c->continuum + t->model;
    const int powers = t->z == 74 ? 3 : 2; /* of the voltage, whose range is wider */
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < powers; j++) place[count++] = f->c[i] + j;
    for (int i = 0; i < 4; i++) place[count++] = f->d + i;
    return count;
}

static double modelled(const target *t, const skg_tube_calibration *c, const sample *s) {
    double sum = 0, kev;
    if (t->kind == CONTINUUM) return skg_tube_continuum(c, t->model, &s->anode, s->kev);
    const int shell = t->kind == K_LINES ? SKG_SHELL_K : SKG_SHELL_L;
    for (int k = 0; k < (t->kind == K_LINES ? SKG_K_LINES : SKG_L_LINES); k++)
        sum += skg_tube_line(c, &s->anode, shell, k, &kev);
    return sum;
}

static int is_of(const target *t, const skg_tube_calibration *c, const sample *s) {
    return s->anode.z == t->z && s->kind == t->kind && (s->anode.kvp > c->seam_kvp) == t->high;
}

/* Weighted differences of logarithms; returns their number. Samples that the model has not are left out: voltages less than
 * 6 % above an edge. */
static int64_t differences(const target *t, const skg_tube_calibration *c, double *out) {
    int64_t n = 0;
    for (int64_t i = 0; i < t->from->count; i++) {
        const sample *s = t->from->all + i;
        if (!is_of(t, c, s)) continue;
        if (t->kind == K_LINES && skg_ebel_overvoltage(&s->anode, SKG_SHELL_K) < 1.06) continue;
        out[n++] = sqrt(s->weight) * log(modelled(t, c, s) / s->photons);
    }
    return n;
}

static double square(int64_t n, const double *v) {
    double sum = 0;
    for (int64_t i = 0; i < n; i++) sum += v[i] * v[i];
    return sum;
}

/* Levenberg and Marquardt's method. Returns the root mean square of the differences, each by its weight. */
static double fit(const target *t, int rounds, skg_tube_calibration *c) {
    double *place[FACTORS_MAX], step[FACTORS_MAX], damping = 1e-3;
    double *now = bench_alloc((size_t)t->from->count, sizeof *now),
           *then = bench_alloc((size_t)t->from->count, sizeof *then);
    const int factors = places(t, c, place);
    const int64_t n = differences(t, c, now);
    double weights = 0;
    skg_least_squares system;
    bench_try(skg_least_squares_create(n + factors, factors, &system), "fit");
    for (int round = 0; round < rounds; round++) {
        int32_t in[FACTORS_MAX];
        for (int f = 0; f < factors; f++) {
            double *column = system.a + f * (n + factors), norm;
            const double h = 1e-5;
            *place[f] += h;
            differences(t, c, then);
            *place[f] -= h;
            for (int64_t i = 0; i < n; i++) column[i] = (then[i] - now[i]) / h;
            norm = sqrt(square(n, column));
            for (int g = 0; g < factors; g++) column[n + g] = g == f ? sqrt(damping) * norm : 0;
            in[f] = f;
        }
        for (int64_t i = 0; i < n + factors; i++) system.b[i] = i < n ? -now[i] : 0;
        skg_least_squares_solve(&system, factors, in, step, NULL);
        for (int f = 0; f < factors; f++) *place[f] += step[f];
        differences(t, c, then);
        const int is_better = square(n, then) < square(n, now);
        for (int f = 0; f < factors && !is_better; f++) *place[f] -= step[f];
        if (is_better) memcpy(now, then, (size_t)n * sizeof *now);
        damping = fmin(fmax(damping * (is_better ? 0.2 : 5), 1e-12), 1e6);
    }
    for (int64_t i = 0; i < t->from->count; i++) {
        const sample *s = t->from->all + i;
        if (is_of(t, c, s)) weights += s->weight;
    }
    const double mean = sqrt(square(n, now) / weights);
    skg_least_squares_release(&system);
    free(now);
    free(then);
    return mean;
}

static void print_row(const char *before, int count, const double *v, const char *after) {
    printf("%s{", before);
    for (int i = 0; i < count; i++) printf("%s%.5f", i ? ", " : "", v[i]);
    printf("}%s", after);
}

static void print_factors(const char *name, const skg_continuum_factors *f) {
    printf("    [%s] = {.c = {", name);
    for (int i = 0; i < 4; i++) print_row("", 3, f->c[i], i < 3 ? ", " : "}, ");
    print_row(".d = ", 4, f->d, ",\n     .h = {");
    for (int i = 0; i < 4; i++) print_row("", 2, f->h[i], i < 3 ? ", " : "}, ");
    print_row(".g = ", 2, f->g, "},\n");
}

int main(int count, char **words) {
    static const struct {
        int32_t z;
        const char *symbol;
    } anodes[] = {{74, "W"}, {42, "Mo"}, {45, "Rh"}};
    bench_arguments arguments = {count, words, 1};
    const char *path = NULL, *value = NULL;
    long rounds = 400;
    while (arguments.next < arguments.count)
        if (bench_option(&arguments, "--rounds", &value))
            bench_numbers(value, 0, 100000, 1, &rounds);
        else if (!bench_option(&arguments, "--spectra", &path))
            bench_usage(&arguments, usage);
    if (!path) bench_usage(&arguments, usage);
    samples s = read_samples(path);
    weigh(&s);
    for (size_t a = 0; a < sizeof anodes / sizeof *anodes; a++) {
        const int32_t z = anodes[a].z;
        skg_tube_calibration c = *skg_tube_calibration_of(z);
        /* Above the seam first, with the factors in use below it. */
        if (c.seam_kvp < c.range.kvp[1]) {
            const double high[] = {fit(&(target){&s, z, CONTINUUM, SKG_TUBE_MODEL_EBEL, 1}, (int)rounds, &c),
                                   fit(&(target){&s, z, CONTINUUM, SKG_TUBE_MODEL_BIRCH, 1}, (int)rounds, &c),
                                   fit(&(target){&s, z, K_LINES, 0, 1}, (int)rounds, &c)};
            printf("%s above %g kV: Ebel %.2f %%, Birch %.2f %%, K lines %.2f %%\n", anodes[a].symbol,
                   c.seam_kvp, 100 * high[0], 100 * high[1], 100 * high[2]);
        }
        const double ebel = fit(&(target){&s, z, CONTINUUM, SKG_TUBE_MODEL_EBEL, 0}, (int)rounds, &c);
        const double birch = fit(&(target){&s, z, CONTINUUM, SKG_TUBE_MODEL_BIRCH, 0}, (int)rounds, &c);
        const double k = fit(&(target){&s, z, K_LINES, 0, 0}, (int)rounds, &c);
        const double l = z == 74 ? fit(&(target){&s, z, L_LINES, 0, 0}, (int)rounds, &c) : 0;
        printf(
            "%s: root mean square of the difference: Ebel %.2f %%, Birch %.2f %%, K lines %.2f %%, L lines %.2f %%\n",
            anodes[a].symbol, 100 * ebel, 100 * birch, 100 * k, 100 * l);
        print_factors("SKG_TUBE_MODEL_EBEL", c.continuum + SKG_TUBE_MODEL_EBEL);
        print_factors("SKG_TUBE_MODEL_BIRCH", c.continuum + SKG_TUBE_MODEL_BIRCH);
        print_row("    .k = ", LINE_FACTORS, c.k, ",\n");
        if (c.seam_kvp < c.range.kvp[1]) print_row("    .k_high = ", 3, c.k_high, ",\n");
        if (z == 74) print_row("    .l = ", LINE_FACTORS, c.l, ",\n");
    }
    free(s.all);
    return 0;
}
