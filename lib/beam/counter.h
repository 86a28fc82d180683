/* The inside of a detector that counts: tables of what it counts by energy. Private. */
#ifndef SKG_COUNTER_H
#define SKG_COUNTER_H

#include "beam/counter_pixels.h"
#include "core/core.h"
#include "pile_up.clh"
#include "skg_shared.h"

#include <skiagraph/counting.h>

#include <pthread.h>

/* Mean counts for a photon of one energy. */
typedef struct {
    double kev;
    /* [windows], then [windows][pixels] where, then [windows][windows][pixels] pairs; if pulses may be moved, then
     * [windows][SKG_PULSE_STEPS] counts by height (skg_pile_up_step) */
    double *counts;
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

/* Whether pulses that overlap may be recorded in another window. */
static inline int skg_counting_moves(const skg_counting *counting) {
    return counting->pile_up != SKG_PILE_UP_NONE && counting->count > 1;
}

/* Doubles of a row: without the heights, and with them. */
static inline int64_t skg_counter_tables_size(int64_t windows) {
    return windows + windows * (1 + windows) * SKG_COUNTING_PIXELS;
}
static inline int64_t skg_counter_row_size(const skg_counting *counting) {
    return skg_counter_tables_size(counting->count) +
           (skg_counting_moves(counting) ? counting->count * SKG_PULSE_STEPS : 0);
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

static inline const double *skg_counter_heights(const skg_counter *counter, const skg_counter_row *row,
                                                int64_t window) {
    return row->counts + skg_counter_tables_size(counter->counting.count) + window * SKG_PULSE_STEPS;
}

/* The rows of some energies, worked out where they are not known yet, by all threads. rows: result: [count], as long as the counter */
skg_status skg_counter_rows_get(skg_counter *counter, int64_t count, const double *energy_kev,
                                const skg_counter_row **rows);

/* The chances that pile_up.clh needs: below: result: [windows][SKG_PULSE_STEPS] that a sum is recorded below a window. */
void skg_pile_up_below(const skg_counting *counting, double *below);

/* Replaces the counts of a pixel in each window before pile-up by those after it. heights: [windows][SKG_PULSE_STEPS] of the pulses of
 * each window, which sum to 1 at most; read if pulses are moved */
void skg_counter_pile(const skg_counting *counting, const double *heights, double *counts);

/* Computes the counts that a pixel records of a beam in each window. exposure: times these photons; recorded: result: [windows] */
skg_status skg_counter_record(skg_counter *counter, int64_t count, const double *energy_kev,
                              const double *photons, double exposure, double *recorded);

#endif
