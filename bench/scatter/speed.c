/* How long scatter takes to an error. */
#include "scatter/speed.h"

#include "../tests/scatter/sums.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Seeds; the middle one of their times and errors is shown. */
enum { REPEATS = 5 };

void speed_head(void) {
    printf(
        "From the cells to the smooth image, warm; the median (and the range) of %d seeds. The error found is the root mean square difference to "
        "a long run, which has an error of its own, over the mean.\n\n"
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

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void speed_rows(const subject *s, int count, const double *tolerances, const double *targets, int64_t truth,
                FILE *csv) {
    taken best = subject_take(s, 0, truth, 99);
    for (int k = 0; k < count; k++) {
        double seconds[REPEATS], cpu[REPEATS], stated[REPEATS], histories[REPEATS], error = 0;
        int cosines = 0;
        for (int r = 0; r < REPEATS; r++) {
            taken t = subject_take(s, tolerances[k], 0, r);
            seconds[r] = t.report.seconds, cpu[r] = t.cpu_s, histories[r] = (double)t.report.histories;
            stated[r] = t.report.sigma / t.report.mean;
            if (t.report.cosines > cosines) cosines = t.report.cosines;
            error += pow(difference(&t, &best), 2) / REPEATS;
            taken_free(&t);
        }
        double *const figures[] = {seconds, cpu, stated, histories};
        for (int f = 0; f < 4; f++) qsort(figures[f], REPEATS, sizeof **figures, by_size);
        char target[32] = "";
        const double middle = seconds[REPEATS / 2];
        if (targets[k] > 0)
            snprintf(target, sizeof target, "%g: %s", targets[k], middle <= targets[k] ? "met" : "MISSED");
        printf("| %s | %" PRId64 " x %" PRId64
               " | %g | %.0f to %.0f | %.2f (%.2f to %.2f) | %.2f | %s | %.2f | %.2f | %d |\n",
               s->name, s->view.columns, s->view.rows, 100 * tolerances[k], histories[0],
               histories[REPEATS - 1], middle, seconds[0], seconds[REPEATS - 1], cpu[REPEATS / 2], target,
               100 * stated[REPEATS / 2], 100 * sqrt(error), cosines);
        fflush(stdout);
        if (csv)
            fprintf(csv, "%s,time to %g %%,%.4g,%.3g,%.3g,%.0f,%g\n", s->name, 100 * tolerances[k], middle,
                    100 * stated[REPEATS / 2], 100 * sqrt(error), histories[REPEATS / 2], targets[k]);
    }
    taken_free(&best);
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
