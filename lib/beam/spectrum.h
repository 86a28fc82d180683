/* The inside of spectra and responses. Private. */
#ifndef SKG_SPECTRUM_PRIVATE_H
#define SKG_SPECTRUM_PRIVATE_H

#include "core/core.h"

#include <skiagraph/beam.h>

struct skg_spectrum {
    skg_refs refs;
    int64_t count;
    double *energy_kev; /* [count], rising */
    double *photons;    /* [count] per pixel, above 0 */
};

/* Makes a spectrum of `count` energies, which the caller fills. */
skg_status skg_spectrum_make(int64_t count, skg_spectrum **spectrum);

/* Whether a response says what is recorded, but not of how many photons: all are then taken as recorded. */
int skg_response_assumes_efficiency(const skg_response *response);

/* The transmission exp(-sum of mu times thickness) of filters at an energy. */
skg_status skg_filters_pass(int64_t count, const skg_filter *filters, double energy_kev, double *passed);

/* The air kerma in uGy of one photon per mm2. */
double skg_air_kerma(double energy_kev);

/* The air kerma in uGy of a spectrum whose photons are per mm2. */
double skg_spectrum_kerma(const skg_spectrum *spectrum);

/* First and second half-value layers of air kerma in mm of a material. */
skg_status skg_half_value_layers(const skg_spectrum *spectrum, const skg_material *material, double *first,
                                 double *second);

/* The anode as a tube model needs it. */
typedef struct {
    int32_t z;
    double kvp, angle_deg;
} skg_anode;

/* Bremsstrahlung photons per keV, mAs and mm2 at 1 m, without filters. Birch's continuum is a shape only: tube.c
 * scales it. */
double skg_ebel_continuum(const skg_anode *anode, double energy_kev);
double skg_birch_continuum(const skg_anode *anode, double energy_kev);

/* Photons of K line k (of SKG_K_LINES) per mAs and mm2 at 1 m; 0 if there is no such line or the voltage is too low.
 * *overvoltage is the tube voltage over the energy of the K edge. */
double skg_ebel_line(const skg_anode *anode, int k, double *energy_kev, double *overvoltage);

#endif
