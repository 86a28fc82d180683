/* Line spread functions that have a given transfer function. Private. */
#ifndef SKG_LINE_SPREAD_H
#define SKG_LINE_SPREAD_H

#include "core/core.h"

#include <skiagraph/options.h>

/* Transfer functions are given at this many equal steps from 0 to the highest frequency that pixels show, half a cycle a
 * pixel, both ends included. */
enum { SKG_TRANSFER_STEPS = 512 };

/* A table of values at spatial frequencies, joined by curves of third degree that rise or fall as the rows do. */
typedef struct {
    int64_t count;
    const double *per_mm, *values;
} skg_frequency_table;

/* Fails with SKG_ERR_ARGUMENT unless frequencies rise from 0 and reach what pixels of this size show. name: "MTF". */
skg_status skg_frequency_table_check(const char *name, const skg_frequency_table *table, double pixel_mm);

double skg_frequency_table_at(const skg_frequency_table *table, double per_mm);

/* Sets transfer [SKG_TRANSFER_STEPS + 1] to the magnitude of the transfer function of samples one pixel apart, over their sum. */
void skg_transfer_of(int64_t count, const double *samples, double *transfer);

/* Measured transfer functions are known to one or two hundredths. */
static const double SKG_TRANSFER_ERROR = 5e-3;

/* Sets line to the fewest samples, an odd number of them, whose transfer function is within SKG_TRANSFER_ERROR of this one, which is
 * 1 at 0. SKG_ERR_ARGUMENT if SKG_LINE_SAMPLES_MAX do not suffice. */
skg_status skg_line_spread_fit(const char *name, const double *transfer, double *line, int64_t *samples);

#endif
