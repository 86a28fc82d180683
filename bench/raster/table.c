/* The results as a table in Markdown, as CSV, and compared with the targets. */
#include "table.h"

#include "common/shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

table_row *table_add(table *rows) {
    table_row *grown = realloc(rows->rows, (size_t)(rows->count + 1) * sizeof *grown);
    if (!grown) bench_die("memory is exhausted");
    rows->rows = grown;
    memset(&grown[rows->count], 0, sizeof *grown);
    return &grown[rows->count++];
}

void table_free(table *rows) {
    free(rows->rows);
    *rows = (table){0};
}

/* The minimum time of contender a over that of contender b. */
static double ratio(const table_row *row, int a, int b) {
    return bench_min(&row->times[a]) / bench_min(&row->times[b]);
}

#if BENCH_EMBREE
static const char names[] =
    "plain C | library | Embree | library vs plain C | library vs Embree | plain C vs Embree |";
static const char rule[] = "---:|---:|---:|---:|---:|---:|";
static const char columns[] =
    "plain_c_min_ms,plain_c_median_ms,library_min_ms,library_median_ms,embree_min_ms,"
    "embree_median_ms,library_vs_plain_c,library_vs_embree,plain_c_vs_embree";
#else
static const char names[] = "plain C | library | library vs plain C |";
static const char rule[] = "---:|---:|---:|";
static const char columns[] =
    "plain_c_min_ms,plain_c_median_ms,library_min_ms,library_median_ms,library_vs_plain_c";
#endif

void table_head(void) {
    printf("Times in ms, minimum / median; ratios of minima: how many times as fast.\n\n"
           "| shape | triangles | detector | %s\n|---|---:|---:|%s\n",
           names, rule);
}

void table_print(const table_row *row) {
    printf("| %s | %lld | %ld | ", shape_name(row->shape), (long long)row->triangles, row->size);
    for (int k = 0; k < CONTENDERS; k++)
        printf("%.3g / %.3g | ", bench_min(&row->times[k]), bench_median(&row->times[k]));
    printf("%.2f |", ratio(row, PLAIN, OURS));
#if BENCH_EMBREE
    printf(" %.1f | %.1f |", ratio(row, EMBREE, OURS), ratio(row, EMBREE, PLAIN));
#endif
    printf("\n");
    fflush(stdout);
}

typedef struct {
    int64_t triangles; /* within 5 % */
    long size;
    double library_plain, library_embree, plain_embree; /* ratios to reach; 0: no target */
} target;

static const target targets[] = {{42000, 512, 2.1, 15, 6.5},
                                 {42000, 1024, 1.8, 18, 9},
                                 {1000000, 1024, 1.5, 8, 0},
                                 {4000000, 512, 1.0, 3.5, 0}};

static void print_target(const char *what, double reached, double asked) {
    if (asked > 0) printf(" %s %.2f of %.1f%s;", what, reached, asked, reached >= asked ? "" : " (missed)");
}

void table_targets(const table *rows) {
    printf("\nTargets, measured of required:\n\n");
    for (size_t t = 0; t < sizeof targets / sizeof *targets; t++) {
        for (int k = 0; k < rows->count; k++) {
            const table_row *row = &rows->rows[k];
            if (row->size != targets[t].size ||
                fabs(log((double)row->triangles / (double)targets[t].triangles)) > 0.05)
                continue;
            printf("- %s, %lld triangles, %ld:", shape_name(row->shape), (long long)row->triangles,
                   row->size);
            print_target("library vs plain C", ratio(row, PLAIN, OURS), targets[t].library_plain);
#if BENCH_EMBREE
            print_target("library vs Embree", ratio(row, EMBREE, OURS), targets[t].library_embree);
            print_target("plain C vs Embree", ratio(row, EMBREE, PLAIN), targets[t].plain_embree);
#endif
            printf("\n");
        }
    }
}

void table_write(const table *rows, const char *path) {
    FILE *file = bench_open(path);
    fprintf(file, "shape,triangles,detector,frames,%s\n", columns);
    for (int k = 0; k < rows->count; k++) {
        const table_row *row = &rows->rows[k];
        fprintf(file, "%s,%lld,%ld,%d", shape_name(row->shape), (long long)row->triangles, row->size,
                row->times[OURS].count);
        for (int c = 0; c < CONTENDERS; c++)
            fprintf(file, ",%.5g,%.5g", bench_min(&row->times[c]), bench_median(&row->times[c]));
        fprintf(file, ",%.3f", ratio(row, PLAIN, OURS));
#if BENCH_EMBREE
        fprintf(file, ",%.2f,%.2f", ratio(row, EMBREE, OURS), ratio(row, EMBREE, PLAIN));
#endif
        fprintf(file, "\n");
    }
    if (fclose(file) != 0) bench_die("%s could not be written", path);
}
