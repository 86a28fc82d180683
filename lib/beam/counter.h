/* The inside of a detector that counts: tables of what it counts by energy. Private. */
#ifndef SKG_COUNTER_H
#define SKG_COUNTER_H

#include "beam/counter_pixels.h"
#include "core/core.h"

#include <skiagraph/counting.h>

#include <pthread.h>

/* What is counted of one energy. */
typedef struct {
    double kev;
    double *counts; /* [windows], then [windows][pixels] where, then [windows][windows][pixels] pairs */
} skg_counter_row;

struct skg_counter {
    skg_refs refs;
    skg_counting counting; /* thresholds point to the array below, the material to that below */
    double thresholds[SKG_THRESHOLDS_MAX];
    skg_material *material; /* retained */
    skg_sensor *sensor;
    pthread_mutex_t lock; /* of the rows */
    int64_t row_count;
    skg_counter_row **rows; /* [row_count] in the order in which they were asked for; never moved */
};

/* Doubles of a row. */
static inline int64_t skg_counter_row_size(int64_t windows) {
    return windows + windows * (1 + windows) * SKG_COUNTING_PIXELS;
}
static inline const double *skg_counter_spread(const skg_counter *counter, const skg_counter_row *row,
                                               int64_t window) {
    return row->counts + counter->counting.count + window * SKG_COUNTING_PIXELS;
}
static inline const double *skg_counter_pairs(const skg_counter *counter, const skg_counter_row *row,
                                              int64_t window, int64_t other) {
    const int64_t windows = counter->counting.count;
    return row->counts + windows + (windows + window * windows + other) * SKG_COUNTING_PIXELS;
}

/* The rows of some energies, worked out where they are not known yet, by all threads. rows: result: [count], as long as the counter */
skg_status skg_counter_rows_get(skg_counter *counter, int64_t count, const double *energy_kev,
                                const skg_counter_row **rows);

#endif
