/* Values as numbers of 16 bits. */
#ifndef CLI_LIVE_NUMBERS_H
#define CLI_LIVE_NUMBERS_H

#include <stdint.h>

/* The least and the largest finite value; both 0 if there is none. Returns whether all are finite. */
int live_range_find(const float *values, int64_t count, float *low, float *high);

/* Writes (value - low) / step, rounded, from 0 to 65535; what is no number as 65535. step: 0: all are written as 0, but what is no
 * number or larger. */
void live_numbers_write(const float *values, int64_t count, float low, double step, uint16_t *numbers);

#endif
