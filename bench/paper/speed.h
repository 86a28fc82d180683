#ifndef BENCH_PAPER_SPEED_H
#define BENCH_PAPER_SPEED_H

#include "paper/study.h"

/* Fig. 17, 18 and Table 5: images per second against triangles, and of a thorax that breathes. */
void paper_speed(const paper_study *study);

#endif
