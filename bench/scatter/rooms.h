/* Scatter in rooms with thin, small and far parts, beside photons that are followed from surface to surface (tests/scatter/rooms.h). */
#ifndef BENCH_SCATTER_ROOMS_H
#define BENCH_SCATTER_ROOMS_H

#include "common/bench.h"

/* Prints a row for each room: to a tolerance, by default 1 %. only: rooms whose names hold it; NULL: all */
void rooms_compare(skg_context *context, const char *only, FILE *csv);

/* Follows photons for the truth, and prints it as tests/scatter/rooms_truth.c has it. */
void rooms_make_truth(const char *only, int64_t histories);

#endif
