/* How long scatter takes to an error. */
#ifndef BENCH_SCATTER_SPEED_H
#define BENCH_SCATTER_SPEED_H

#include "scatter/subject.h"

/* Prints rows of a table that speed_head begins: the tolerances of a scene, each beside a run of `truth` histories, and writes them.
 * targets: s for each tolerance; 0: none */
void speed_head(void);
void speed_rows(const subject *s, int count, const double *tolerances, const double *targets, int64_t truth,
                FILE *csv);

/* Prints the figure of merit 1 / (variance x CPU time) of single pixels of 20 cm of water before smoothing, beside EGSnrc's. */
void speed_merit(skg_context *context, int64_t histories, FILE *csv);

#endif
