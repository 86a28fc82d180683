/* Counts of the pixels of a counting detector for the charge of one photon. Private. */
#ifndef SKG_COUNTER_PIXELS_H
#define SKG_COUNTER_PIXELS_H

#include "beam/counter_sensor.h"

#include "pile_up.clh"
#include "skg_shared.h"

enum { SKG_COUNTING_PIXELS = SKG_COUNTING_SIDE * SKG_COUNTING_SIDE };

/* The standard deviation of the cloud of charge that was set free at a depth when it reaches the pixels, mm: it drifts for
 * t = d thickness / (mobility bias), and its variance grows by 2 D t with D = mobility kT/e (H. Spieler, Semiconductor Detector Systems,
 * 2005). */
double skg_cloud_width(const skg_counting *counting, double z);

/* The noise of a recorded pulse: of a pixel, or of the four that anti-coincidence sums, keV. */
double skg_pulse_noise(const skg_counting *counting);

/* The size of a step of heights, of which there are SKG_PULSE_STEPS: to where a pulse is surely above all thresholds, keV. */
double skg_pulse_step(const skg_counting *counting);

/* The lowest step that a recorded pulse may have. */
int32_t skg_pulse_first(const skg_counting *counting);

/* Adds the counts of one history to those of a row. heights: likewise [windows][SKG_PULSE_STEPS] counts by height; NULL: not wanted */
void skg_pixels_count(const skg_counting *counting, int count, const skg_deposit *deposits, double *counts,
                      double *heights);

#endif
