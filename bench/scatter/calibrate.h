/* The error that is stated against the error that is found. */
#ifndef BENCH_SCATTER_CALIBRATE_H
#define BENCH_SCATTER_CALIBRATE_H

#include "scatter/subject.h"

/* Prints rows of a table that calibrate_head begins: for each tolerance the frames of `seeds` seeds beside the mean of long runs. */
void calibrate_head(int seeds);
void calibrate_rows(const subject *s, int seeds, int count, const double *tolerances, FILE *csv);

#endif
