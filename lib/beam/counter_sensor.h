/* Histories of photons in the sensor of a detector that counts. Private. */
#ifndef SKG_COUNTER_SENSOR_H
#define SKG_COUNTER_SENSOR_H

#include "material/material.h"

#include <skiagraph/counting.h>

enum {
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

#endif
