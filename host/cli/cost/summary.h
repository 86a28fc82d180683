/* The scene's costs in one sentence, and what is worth changing. */
#ifndef SKG_CLI_COST_SUMMARY_H
#define SKG_CLI_COST_SUMMARY_H

#include "cost/study.h"

/* Fills in study->buy, ->saving and ->summary. */
void cost_summarise(cost_study *study);

/* "0.21 %", for a fraction. size: 16 suffice. */
const char *cost_percent(double share, char *text, size_t size);

/* "8.1 ms", with "+-" and the spread where it is known and matters. */
const char *cost_ms(double ms, double spread_ms, char *text, size_t size);

/* What a change adds to a time: "+3.1 ms", "+3.1 +- 0.2 ms", "-2 ms", "in the same time". */
const char *cost_more(double ms, double spread_ms, char *text, size_t size);

#endif
