/* The inside of a detector that counts: histories of photons, and what pixels make of their charge. Private. */
#ifndef SKG_COUNTER_H
#define SKG_COUNTER_H

#include "core/core.h"
#include "material/material.h"

#include <skiagraph/counting.h>

#include <pthread.h>

enum {
    SKG_COUNTING_PIXELS = SKG_COUNTING_SIDE * SKG_COUNTING_SIDE,
    SKG_DEPOSITS_MAX = 8, /* places in which a photon leaves energy */
    /* Of photons that interact, for each energy; a power of 2. With eight times as many, counts of a window differ by
     * less than 0.01 of a photon's (measured). */
    SKG_HISTORIES = 16384
};

/* Energy that is left in one place; mm from the corner of the pixel that the photon enters, z from the side that it enters. */
typedef struct {
    double x, y, z, kev;
} skg_deposit;

/* Histories of photons in a sensor. */
typedef struct skg_sensor skg_sensor;

/* material is borrowed; fluorescence 0: K fluorescence stays where it is set free. */
skg_status skg_sensor_create(const skg_material *material, const skg_counting *counting, skg_sensor **sensor);
void skg_sensor_release(skg_sensor **sensor);

/* Photons of one energy; prepared once for all their histories. */
typedef struct skg_arrival skg_arrival;
skg_status skg_arrival_create(const skg_sensor *sensor, double energy_kev, skg_arrival **arrival);
void skg_arrival_release(skg_arrival **arrival);

/* The share of the photons that interact, by photo absorption or Compton scattering. */
double skg_arrival_efficiency(const skg_arrival *arrival);

/* History number `index` of photons that interact. Returns the number of deposits. */
int skg_arrival_follow(const skg_arrival *arrival, int64_t index, skg_deposit deposits[SKG_DEPOSITS_MAX]);

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

/* The standard deviation of the cloud of charge that was set free at a depth when it reaches the pixels, mm: it drifts for
 * t = d thickness / (mobility bias), and its variance grows by 2 D t with D = mobility kT/e (H. Spieler, Semiconductor Detector Systems,
 * 2005, section 2.3). */
double skg_cloud_width(const skg_counting *counting, double z);

/* Adds the counts of one history to those of a row. */
void skg_pixels_count(const skg_counting *counting, int count, const skg_deposit *deposits, double *counts);

/* The rows of some energies, worked out where they are not known yet, by all threads. rows: result: [count], as long as the counter */
skg_status skg_counter_rows_get(skg_counter *counter, int64_t count, const double *energy_kev,
                                const skg_counter_row **rows);

#endif
