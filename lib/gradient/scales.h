/* Scales by which the sums of a gather are integers. Private. */
#ifndef SKG_GRADIENT_SCALES_H
#define SKG_GRADIENT_SCALES_H

#include "gradient/gather_run.h"

/* Powers of two by which weights become integers, and what a moment of 1 is worth. most: [planes] the largest weights. around: NULL, or what
 * stands around the parts. scales: [2][parts]; units: [2][parts] */
void skg_gradient_find_scales(const skg_gather_run *run, const double *most, const skg_surroundings *around,
                              double *scales, double *units);

/* One scale for the hits of the parts that move, whose slopes are at most `slope`; 0: all derivatives are 0. scales: [parts], 0 of
 * those that do not */
double skg_gradient_find_scale(const skg_gather_run *run, const double *most, const uint8_t *moves,
                               double slope, double *scales);

/* The unit of the contributions of a part on the device: they weigh q = r / reference, with a parallel beam r. */
double skg_gradient_depth_unit(const skg_gather_run *run, int64_t part);

#endif
