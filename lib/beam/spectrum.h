/* The inside of spectra and responses. Private. */
#ifndef SKG_SPECTRUM_PRIVATE_H
#define SKG_SPECTRUM_PRIVATE_H

#include "core/core.h"

#include <skiagraph/beam.h>

struct skg_spectrum {
    skg_refs refs;
    int32_t absolute; /* 1: photons are per microsteradian, not per pixel */
    int32_t unloaded; /* 1: of a tube whose load is not known, so that the number of photons means nothing */
    int64_t count;
    double *energy_kev; /* [count], rising */
    double *photons;    /* [count] above 0 */
};

/* Makes a spectrum of `count` energies, which the caller fills. */
skg_status skg_spectrum_make(int64_t count, skg_spectrum **spectrum);

/* The microsteradians that a pixel of an area at the foot of the perpendicular from the source fills. */
double skg_microsteradians(double pixel_mm2, double distance_mm);

/* Makes a spectrum times a factor, whose photons are per pixel. */
skg_status skg_spectrum_create_counts(const skg_spectrum *spectrum, double factor, skg_spectrum **counts);

/* Whether a response says what is recorded, but not of how many photons: all are then taken as recorded. */
int skg_response_assumes_efficiency(const skg_response *response);

/* Whether a response is that of a layer, which depends on how oblique photons cross it. */
int skg_response_is_layer(const skg_response *response);

/* Of the photons that interact in a layer, the share that does so between two depths, given as shares of its thickness. oblique: path
 * through the layer over its thickness */
skg_status skg_response_depth_share(const skg_response *response, double energy_kev, double oblique,
                                    double from, double to, double *share);

/* The lowest energy that a response is given for, keV; 0: any. */
double skg_response_lowest(const skg_response *response);

/* Whether K fluorescence leaves the layer. */
int skg_response_escapes(const skg_response *response);

/* 1 if scattered photons are followed in its layer. */
int skg_response_transports(const skg_response *response);

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

/* Bremsstrahlung photons per keV, mAs and mm2 at 1 m, without filters, as published if deeper is 1. deeper: factor on the
 * depth at which photons are made. Birch's has an unknown unit, which the calibration knows. */
double skg_ebel_continuum(const skg_anode *anode, double energy_kev, double deeper);
double skg_birch_continuum(const skg_anode *anode, double energy_kev, double deeper);

/* Tube voltage over the energy of the shell's edge; 0: the element's shell is not in the tables. */
double skg_ebel_overvoltage(const skg_anode *anode, int32_t shell);

/* Photons of a line (of SKG_K_LINES or SKG_L_LINES) per mAs and mm2 at 1 m, those of L in an unknown unit; 0 if there is
 * no such line or the voltage is too low. */
double skg_ebel_line(const skg_anode *anode, int32_t shell, int line, double deeper, double *energy_kev);

/* The range for which the calibration of an anode was made. */
typedef struct {
    int32_t z, reserved;
    double kvp[2], angle_deg[2];
} skg_tube_range;

/* Factors on continuum and lines, and on the depths at which photons are made: calibration.c has their formulas. */
typedef struct {
    double c[4][3], d[4];
    double h[4][2], g[2]; /* above the seam */
    double e[4];          /* beyond the range */
} skg_continuum_factors;

typedef struct {
    skg_tube_range range;
    double seam_kvp; /* where factors of higher voltages begin; the end of the range: there are none */
    double last_kvp; /* up to which spectra follow another computation than that of the range; 0: none */
    skg_continuum_factors continuum[2]; /* by SKG_TUBE_MODEL_ */
    double k[5], l[5], k_high[3];
} skg_tube_calibration;

/* The calibration of an anode; that of tungsten if the element has none. */
const skg_tube_calibration *skg_tube_calibration_of(int32_t z);

/* Continuum and lines, calibrated, in the units of above. */
double skg_tube_continuum(const skg_tube_calibration *calibration, int32_t model, const skg_anode *anode,
                          double energy_kev);
double skg_tube_line(const skg_tube_calibration *calibration, const skg_anode *anode, int32_t shell, int line,
                     double *energy_kev);

skg_status skg_tube_check(const skg_tube *tube);

/* The unfiltered spectrum of a checked tube per mAs and mm2 at 1 m, every bin from SKG_LOWEST_KEV on. */
skg_status skg_tube_bare(const skg_tube *tube, skg_spectrum **spectrum);

/* The tube of a heel effect. */
typedef struct {
    int32_t anode, reserved;
    double kvp, angle_deg, bin_kev;
} skg_heel_tube;

/* Sets losses [energies of the spectrum] to -ln of the photons that leave the anode at an angle over those that leave it at
 * the tube's. */
skg_status skg_heel_losses(const skg_heel_tube *heel, double angle_deg, const skg_spectrum *spectrum,
                           double *losses);

#endif
