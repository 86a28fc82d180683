/* Clocks of a run: wall time, in which other processes take their share, and processor time, in which they do not. */
#ifndef CLI_COST_CLOCK_H
#define CLI_COST_CLOCK_H

#include "cost/study.h"

enum { COST_THREADS_MAX = 1024 };

/* Times in ms. */
typedef struct {
    double wall;                     /* what a user waits */
    double own;                      /* processor time of the calling thread */
    int count;                       /* other threads of this process; 0: their times cannot be read here */
    int ids[COST_THREADS_MAX];       /* [count] */
    double others[COST_THREADS_MAX]; /* [count] their processor times */
} cost_instant;

/* Fills in the clocks of the beginning or of the end of a run. Reading those of many threads takes a while, which is not in `wall`. */
void cost_begin(cost_instant *begun);
void cost_end(cost_instant *ended);

/* Finds out whether prices are processor times: the device's threads are those of this process, and their times can be read. */
void cost_choose_clock(cost_study *study);

/* "cpu" where they are; otherwise "wall". */
const char *cost_clock_name(const cost_study *study);

/* Price of the run from `begun` to `ended`, ms on an idle machine: the processor time of the calling thread, which hands work over, and of
 * the busiest of the other threads, and never more than the wall time; by the clock "wall" the wall time. */
double cost_price_ms(const cost_study *study, const cost_instant *begun, const cost_instant *ended);

#endif
