/* The error that is stated against the error that is found. */
#include "scatter/calibrate.h"

#include <math.h>
#include <stdlib.h>

/* Blocks along a side; long runs, and their histories. */
enum { SIDE = 8, BLOCKS = SIDE * SIDE, RUNS = 4, LONG = 1 << 21 };

void calibrate_head(int seeds) {
    printf(
        "Error over what is stated, of %d seeds beside %d runs of %d histories, whose own error is included. Blocks: %d x %d, whose mean "
        "square lies where 95 in 100 of so many normal errors have theirs.\n\n"
        "| scene | tolerance, %% | mean histories | stated, %% | found, %% | rms of error over stated | blocks as expected, %% |\n"
        "|---|---|---|---|---|---|---|\n",
        seeds, RUNS, LONG, SIDE, SIDE);
}

static double *long_run(const subject *s) {
    const int64_t count = s->view.rows * s->view.columns;
    double *truth = bench_alloc((size_t)count, sizeof *truth);
    for (int64_t i = 0; i < count; i++) truth[i] = 0;
    for (int r = 0; r < RUNS; r++) {
        taken t = subject_take(s, 0, LONG, 9000 + r);
        for (int64_t i = 0; i < count; i++) truth[i] += t.scatter[i] / RUNS;
        taken_free(&t);
    }
    return truth;
}

/* Sums over seeds and pixels. */
typedef struct {
    double histories, stated, found, ratio, blocks[BLOCKS];
    int64_t pixels[BLOCKS];
} sums;

static void add(const subject *s, const double *truth, const taken *t, sums *all) {
    for (int64_t i = 0; i < t->count; i++) {
        const int64_t row = i / s->view.columns * SIDE / s->view.rows,
                      column = i % s->view.columns * SIDE / s->view.columns;
        const double off = t->scatter[i] - truth[i], ratio = off / t->sigma[i];
        all->found += off * off;
        all->stated += t->sigma[i] * t->sigma[i];
        all->ratio += ratio * ratio;
        all->blocks[row * SIDE + column] += ratio * ratio;
        all->pixels[row * SIDE + column]++;
    }
    all->histories += (double)t->report.histories;
}

/* Chi square over its degrees of freedom at a normal quantile (E. B. Wilson and M. M. Hilferty, The distribution of chi-square, Proceedings
 * of the National Academy of Sciences 17 (1931) 684-688). */
static double quantile(int degrees, double normal) {
    const double part = 2 / (9.0 * degrees);
    return pow(1 - part + normal * sqrt(part), 3);
}

void calibrate_rows(const subject *s, int seeds, int count, const double *tolerances, FILE *csv) {
    double *truth = long_run(s), mean = 0;
    const double pixels = (double)(s->view.rows * s->view.columns);
    for (int64_t i = 0; i < s->view.rows * s->view.columns; i++) mean += truth[i] / pixels;
    for (int k = 0; k < count; k++) {
        sums all = {0};
        int within = 0;
        for (int seed = 0; seed < seeds; seed++) {
            taken t = subject_take(s, tolerances[k], 0, 100 + seed);
            add(s, truth, &t, &all);
            taken_free(&t);
        }
        for (int b = 0; b < BLOCKS; b++) {
            const double square = all.blocks[b] / (double)all.pixels[b];
            within += square > quantile(seeds, -1.96) && square < quantile(seeds, 1.96);
        }
        const double each = pixels * seeds, stated = 100 * sqrt(all.stated / each) / mean,
                     found = 100 * sqrt(all.found / each) / mean;
        printf("| %s | %g | %.0f | %.2f | %.2f | %.2f | %.0f |\n", s->name, 100 * tolerances[k],
               all.histories / seeds, stated, found, sqrt(all.ratio / each), 100.0 * within / BLOCKS);
        fflush(stdout);
        if (csv)
            fprintf(csv, "%s,error over stated at %g %%,%.4g,%.3g,%.3g,%.0f,\n", s->name, 100 * tolerances[k],
                    sqrt(all.ratio / each), stated, found, all.histories / seeds);
    }
    free(truth);
}
