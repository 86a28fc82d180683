/* The results as a table in Markdown, as CSV, and compared with the targets. */
#ifndef BENCH_TABLE_H
#define BENCH_TABLE_H

#include "common/bench.h"

enum {
    PLAIN = 0,
    OURS = 1,
#if BENCH_EMBREE
    EMBREE = 2,
#endif
    CONTENDERS
};

typedef struct {
    int shape;
    int64_t triangles;
    long size;
    bench_times times[CONTENDERS];
} table_row;

typedef struct {
    int count;
    table_row *rows;
} table;

/* Adds a row of zeros, which stays valid until the next row is added. */
table_row *table_add(table *rows);
void table_head(void);
void table_print(const table_row *row);
/* Prints the ratios that are targets beside those measured, for the cases that were measured. */
void table_targets(const table *rows);
void table_write(const table *rows, const char *path);
void table_free(table *rows);

#endif
