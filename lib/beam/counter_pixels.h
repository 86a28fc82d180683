/* What the pixels of a detector that counts make of the charge of one photon. Private. */
#ifndef SKG_COUNTER_PIXELS_H
#define SKG_COUNTER_PIXELS_H

#include "beam/counter_sensor.h"

enum { SKG_COUNTING_PIXELS = SKG_COUNTING_SIDE * SKG_COUNTING_SIDE };

/* The standard deviation of the cloud of charge that was set free at a depth when it reaches the pixels, mm: it drifts for
 * t = d thickness / (mobility bias), and its variance grows by 2 D t with D = mobility kT/e (H. Spieler, Semiconductor Detector Systems,
 * 2005). */
double skg_cloud_width(const skg_counting *counting, double z);

/* Adds the counts of one history to those of a row. */
void skg_pixels_count(const skg_counting *counting, int count, const skg_deposit *deposits, double *counts);

#endif
