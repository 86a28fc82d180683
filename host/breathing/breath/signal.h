/* A recorded signal: amplitudes over time. Private. */
#ifndef SKG_BREATH_SIGNAL_H
#define SKG_BREATH_SIGNAL_H

#include <skiagraph/breath.h>

/* SKG_ERR_BREATHING: fewer than two points, times that do not rise, amplitudes beyond 0 to 1. */
skg_status skg_signal_check(const skg_breath *breath);

/* The amplitude at a time: linear between points, constant beyond them. */
double skg_signal_amplitude(const skg_breath *breath, double time);

/* The phase at a time, which may be below 0 or above 1. */
double skg_signal_phase(const skg_breath *breath, double time);

/* Reads a file of rows of time in s and amplitude in any unit. The first time becomes 0, the least amplitude 0, the greatest
 * 1.
 *
 * points   result: [count][2], which the caller frees
 * errors   SKG_ERR_FILE; SKG_ERR_FORMAT with the row */
skg_status skg_signal_load(const char *path, double **points, int64_t *count);

#endif
