/* This file is compiled for vectors: a frame of 512 x 512 pixels passes through it each time. */
#include "live/numbers.h"

#include <float.h>
#include <math.h>

enum { LANES = 8 };

/* What is known of the values so far, in lanes, which compilers turn into vectors. */
typedef struct {
    float low[LANES], high[LANES];
    float beyond[LANES]; /* 0: all are finite */
} range;

static void widen(range *of, int k, float value) {
    const int is_finite = fabsf(value) <= FLT_MAX;
    const float least = is_finite ? value : INFINITY, most = is_finite ? value : -INFINITY;
    of->low[k] = least < of->low[k] ? least : of->low[k];
    of->high[k] = most > of->high[k] ? most : of->high[k];
    of->beyond[k] += is_finite ? 0.0F : 1.0F;
}

int live_range_find(const float *values, int64_t count, float *low, float *high) {
    const int64_t whole = count / LANES * LANES;
    range of;
    for (int k = 0; k < LANES; k++) of.low[k] = INFINITY, of.high[k] = -INFINITY, of.beyond[k] = 0;
    for (int64_t i = 0; i < whole; i += LANES)
        for (int k = 0; k < LANES; k++) widen(&of, k, values[i + k]);
    for (int64_t i = whole; i < count; i++) widen(&of, 0, values[i]);
    for (int k = 1; k < LANES; k++) {
        of.low[0] = of.low[k] < of.low[0] ? of.low[k] : of.low[0];
        of.high[0] = of.high[k] > of.high[0] ? of.high[k] : of.high[0];
        of.beyond[0] += of.beyond[k];
    }
    const int is_empty = !(of.low[0] <= of.high[0]);
    *low = is_empty ? 0 : of.low[0], *high = is_empty ? 0 : of.high[0];
    return of.beyond[0] == 0;
}

void live_numbers_write(const float *values, int64_t count, float low, double step, uint16_t *numbers) {
    const float scale = step > 0 ? (float)(1 / step) : 0;
    for (int64_t i = 0; i < count; i++) {
        float number = (values[i] - low) * scale + 0.5F;
        number = number <= UINT16_MAX ? number : UINT16_MAX;
        number = number > 0 ? number : 0;
        numbers[i] = (uint16_t)(int32_t)number;
    }
}
