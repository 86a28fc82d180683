#include "scatter/speed.h"

#include "../tests/scatter/sums.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

enum { REPEATS = 3 };

void speed_head(void) {
    printf(
        "From the cells to the smooth image, warm; the least of %d runs. The error found is the root mean square difference to "
        "a long run, over the mean.\n\n"
        "| scene | pixels | tolerance, %% | histories | s | CPU s | target, s | error stated, %% | error found, %% | cosines |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        REPEATS);
}

static double difference(const taken *a, const taken *b) {
    double square = 0, mean = 0;
    for (int64_t i = 0; i < a->count; i++) {
        square += pow(a->scatter[i] - b->scatter[i], 2) / (double)a->count;
        mean += b->scatter[i] / (double)a->count;
    }
    return sqrt(square) / mean;
}

void speed_rows(const subject *s, int count, const double *tolerances, const double *targets, double truth,
                FILE *csv) {
    taken best = subject_take(s, truth, 0, 99);
    for (int k = 0; k < count; k++) {
        double seconds = HUGE_VAL, cpu = HUGE_VAL, error = 0;
        taken t = {0};
        for (int r = 0; r < REPEATS; r++) {
            taken_free(&t);
            t = subject_take(s, tolerances[k], 0, r);
            seconds = fmin(seconds, t.report.seconds);
            cpu = fmin(cpu, t.cpu_s);
            error += pow(difference(&t, &best), 2) / REPEATS;
        }
        char target[32] = "";
        if (targets[k] > 0)
            snprintf(target, sizeof target, "%g: %s", targets[k], seconds <= targets[k] ? "met" : "MISSED");
        printf("| %s | %" PRId64 " x %" PRId64 " | %g | %" PRId64
               " | %.2f | %.2f | %s | %.2f | %.2f | %d |\n",
               s->name, s->view.columns, s->view.rows, 100 * tolerances[k], t.report.histories, seconds, cpu,
               target, 100 * t.report.sigma / t.report.mean, 100 * sqrt(error), (int)t.report.cosines);
        fflush(stdout);
        if (csv)
            fprintf(csv, "%s,time to %g %%,%.4g,%.3g,%.3g,%" PRId64 ",%g\n", s->name, 100 * tolerances[k],
                    seconds, 100 * t.report.sigma / t.report.mean, 100 * sqrt(error), t.report.histories,
                    targets[k]);
        taken_free(&t);
    }
    taken_free(&best);
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median over the places of their relative standard error, from the batches. */
static double median_error(const taken *t) {
    double *errors = bench_alloc((size_t)t->places, sizeof *errors);
    for (int64_t p = 0; p < t->places; p++) {
        double sum = 0, square = 0;
        for (int64_t b = 0; b < SUMS_BATCHES; b++) {
            double value = 0;
            for (int k = 0; k < SUMS_KINDS; k++)
                value += (double)t->sums[(b * SUMS_PLANES + k) * t->places + p];
            sum += value, square += value * value;
        }
        const double mean = sum / SUMS_BATCHES;
        errors[p] = sqrt((square - sum * mean) / (SUMS_BATCHES * (SUMS_BATCHES - 1.0))) / mean;
    }
    qsort(errors, (size_t)t->places, sizeof *errors, by_size);
    const double median = errors[t->places / 2];
    free(errors);
    return median;
}

void speed_merit(skg_context *context, int64_t histories, FILE *csv) {
    /* Median noise of a pixel and CPU time of EGSnrc's images, 9e8 histories, from their notes. */
    static const struct {
        const char *name;
        double plane, error, cpu_s;
    } slabs[] = {{"w0", 100.00001, 0.0049, 774}, {"w1", 300, 0.0074, 806}};
    printf(
        "\nFigure of merit, 1 / (variance x CPU time), of single pixels before smoothing: the median pixel of 32 x 32.\n\n"
        "| slab | EGSnrc: noise, %% | CPU s | ours: noise, %% | CPU s | ours over EGSnrc's |\n|---|---|---|---|---|---|\n");
    for (size_t k = 0; k < sizeof slabs / sizeof *slabs; k++) {
        subject s = subject_water(context, slabs[k].name, slabs[k].plane, 1);
        taken t = subject_take(&s, 0, histories, 1);
        const double error = median_error(&t), theirs = slabs[k].error * slabs[k].error * slabs[k].cpu_s,
                     merit = theirs / (error * error * t.cpu_s);
        printf("| %s | %.2f | %.0f | %.2f | %.2f | %.0f |\n", slabs[k].name, 100 * slabs[k].error,
               slabs[k].cpu_s, 100 * error, t.cpu_s, merit);
        if (csv)
            fprintf(csv, "%s,figure of merit over EGSnrc's,%.4g,%.3g,,%" PRId64 ",\n", slabs[k].name, merit,
                    100 * error, t.report.histories);
        taken_free(&t);
        subject_close(&s);
    }
}
