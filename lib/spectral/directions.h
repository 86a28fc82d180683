/* The few directions that span how a beam is thinned in many states, such as angles. Private. */
#ifndef SKG_DIRECTIONS_H
#define SKG_DIRECTIONS_H

#include "beam/spectrum.h"

enum { SKG_DIRECTIONS_MAX = 4 };

typedef struct {
    int64_t states, bins;
    int32_t count, reserved; /* of directions that were taken */
    double *weight;          /* [bins] roots of shares of the beam's energy */
    double *losses;          /* [states][bins] by the caller: -ln of what a state leaves of the photons */
    double *scale;           /* [states] by the caller: errors of a state count by this much; 1 at first */
    double *amounts;         /* [SKG_DIRECTIONS_MAX][states] */
    double *unit;            /* [SKG_DIRECTIONS_MAX][bins] losses for an amount of 1 */
    double error; /* that is left of the logarithm, by the least squares of the beam's energies, scaled */
} skg_directions;

skg_status skg_directions_create(const skg_spectrum *spectrum, int64_t states, skg_directions *directions);
void skg_directions_release(skg_directions *directions);

/* Finds directions, units and amounts, until what is left of every state is negligible or the most are taken. The losses are
 * used up. */
void skg_directions_find(skg_directions *directions);

/* Points between -1 and 1 at which a function is needed for skg_directions_fit: Chebyshev's, as states 0, 1, ... */
enum { SKG_FIT_POINTS = 24, SKG_FIT_TERMS = 12 };
double skg_fit_point(int state);

/* Sets terms to the coefficients of 1, z, z^2, ... of a polynomial through values at the points, by least squares. Returns the
 * largest error there. */
double skg_fit(const double values[SKG_FIT_POINTS], double terms[SKG_FIT_TERMS]);

#endif
