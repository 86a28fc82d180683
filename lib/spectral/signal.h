/* What one photon adds to an image, by its energy. Private. */
#ifndef SKG_SIGNAL_H
#define SKG_SIGNAL_H

#include <skiagraph/plan.h>

/* To the image: the recorded energy, keV, or 1 if photons are counted, times the efficiency of the response. */
skg_status skg_signal_get(const skg_plan_options *options, double energy_kev, double *signal);

/* The same of a photon that crosses the layer of a scintillator along `oblique` times its thickness. */
skg_status skg_signal_oblique_get(const skg_plan_options *options, double energy_kev, double oblique,
                                  double *signal);

/* To the variance, of a photon that adds `signal` (docs/physics.md, Noise). */
skg_status skg_signal_variance_get(const skg_plan_options *options, double energy_kev, double signal,
                                   double *variance);

#endif
