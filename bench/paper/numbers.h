#ifndef BENCH_PAPER_NUMBERS_H
#define BENCH_PAPER_NUMBERS_H

#include "paper/study.h"

/* Sections 4.3.2 and 4.3.3: lengths and intensities of one ray in half, single and double, beside the printed
 * values. Returns 1 if half does not give the values that are printed for 16 bits, otherwise 0. */
int paper_numbers(const paper_study *study);

#endif
