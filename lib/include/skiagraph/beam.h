/* Spectra: how many photons of which energy reach a pixel of the open beam; and what a detector makes of
 * them.
 *
 * Spectra and responses never change once made and may be shared by threads. Failures are SKG_ERR_BEAM unless
 * said otherwise. Energies are 1 keV to 20 MeV. */
#ifndef SKIAGRAPH_BEAM_H
#define SKIAGRAPH_BEAM_H

#include <skiagraph/context.h>
#include <skiagraph/material.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_spectrum skg_spectrum;

/* One energy in keV and a number of photons per pixel (finite, > 0). */
SKG_API skg_status skg_spectrum_create_mono(double energy_kev, double photons, skg_spectrum **spectrum);

/* `count` >= 1 energies in keV, in any order, and photons per pixel (finite, >= 0, not all 0). Equal energies
 * are added, energies without photons left out. */
SKG_API skg_status skg_spectrum_create_bins(int64_t count, const double *energies_kev, const double *photons,
                                            skg_spectrum **spectrum);

/* From a text file: two columns, energy in the unit ("eV", "keV", "MeV") and photons per pixel; lines with #
 * are read past. Or a GATE macro: of its lines those with "histpoint" or "hist/point", energy and weight.
 * Errors: SKG_ERR_FILE, SKG_ERR_FORMAT with the line. */
SKG_API skg_status skg_spectrum_load(const char *path, const char *unit, skg_spectrum **spectrum);

/* A layer in the beam. */
typedef struct {
    const skg_material *material; /* of known density */
    double mm;                    /* thickness, >= 0 */
} skg_filter;

/* The spectrum behind filters; energies of which less than 1e-9 of the strongest is left are left out. */
SKG_API skg_status skg_spectrum_create_filtered(const skg_spectrum *spectrum, int64_t count,
                                                const skg_filter *filters, skg_spectrum **behind);

/* All photon numbers times factor, finite and above 0. */
SKG_API skg_status skg_spectrum_create_scaled(const skg_spectrum *spectrum, double factor,
                                              skg_spectrum **scaled);

enum {
    SKG_TUBE_MODEL_EBEL =
        0, /* H. Ebel, X-Ray Spectrom. 28 (1999) 255: continuum and K lines of a reflection target */
    SKG_TUBE_MODEL_BIRCH =
        1 /* R. Birch and M. Marshall, Phys. Med. Biol. 24 (1979) 505: the paper's; lines as above */
};

/* An X-ray tube. Prepare with skg_tube_init; set kvp.
 *
 * Output and K lines are calibrated for tungsten to SpekPy 2.5 (air kerma at 1 m, 12 degrees, 2.5 mm
 * Al: 48.9, 82.0, 118.9, 158.7, 222.8 uGy/mAs at 60, 80, 100, 120, 150 kV, kept within 5 %). Both models give
 * the same air kerma behind 2.5 mm Al. L lines are absent: below 15 keV not warranted. No inherent filtration
 * is assumed; from 70 kV on, less than the hardness of 2.5 mm Al (IEC 60601-1-3) is a warning. */
typedef struct {
    int32_t size;
    int32_t model;      /* SKG_TUBE_MODEL_EBEL (default) or SKG_TUBE_MODEL_BIRCH */
    double kvp;         /* kV, 10 to 450; validated from 20 to 150 */
    double angle_deg;   /* of the anode's face to the central ray, 3 to 60; default 12 */
    int32_t anode;      /* atomic number, 20 to 92; default 74; others are not validated */
    int32_t reserved;   /* 0 */
    double bin_kev;     /* width of a bin, 0.1 to 10; default 1; energies are their middles */
    double mas;         /* tube current times time; default 1 */
    double distance_mm; /* from the focal spot to the pixel; default 1000 */
    double pixel_mm2;   /* default 1: then photons are per mm2 */
    double
        output_ugy_mas;  /* air kerma per mAs behind the filters that replaces the model's; 0: the model's */
    double output_at_mm; /* at this distance; default 1000 */
    int64_t filter_count;
    const skg_filter *filters; /* all of them: inherent, added, air */
    skg_context *context;      /* for warnings; may be NULL */
    skg_log_function log;      /* receives the warnings where there is no context; may be NULL */
    void *log_user;
} skg_tube;

SKG_API void skg_tube_init(skg_tube *tube);
SKG_API skg_status skg_spectrum_create_tube(const skg_tube *tube, skg_spectrum **spectrum);

SKG_API skg_status skg_spectrum_retain(skg_spectrum *spectrum);
SKG_API void skg_spectrum_release(skg_spectrum **spectrum);

/* How many energies the spectrum has, rising, and the one at 0 <= index < count: keV and photons per pixel.
 */
SKG_API skg_status skg_spectrum_bin_count(const skg_spectrum *spectrum, int64_t *count);
SKG_API skg_status skg_spectrum_bin_get(const skg_spectrum *spectrum, int64_t index, double *energy_kev,
                                        double *photons);

/* What a beam is judged by. Prepare with skg_quality_init. Half-value layers are of air kerma, whose energy
 * transfer coefficient is photo absorption, free Klein-Nishina and pairs (0.6 % above NIST's mu_en/rho at
 * 10 keV, 0.2 % at 80 keV). */
typedef struct {
    int32_t size;
    int32_t reserved; /* 0 */
    double photons;
    double energy_kev; /* of all photons together */
    double mean_kev;   /* energy_kev / photons */
    double hvl1_mm_al, hvl2_mm_al, hvl1_mm_cu, hvl2_mm_cu;
    double homogeneity;   /* hvl1 / hvl2 in aluminium */
    double air_kerma_ugy; /* where photons are per mm2 */
} skg_quality;

SKG_API void skg_quality_init(skg_quality *quality);
SKG_API skg_status skg_spectrum_quality_get(const skg_spectrum *spectrum, skg_quality *quality);

/* What a detector records of a photon. No response (NULL, where one is taken) is the ideal detector: every
 * photon, all its energy. */
typedef struct skg_response skg_response;

/* count >= 2 energies in keV, rising, and mean recorded energies in keV, 0 to the photon's own; linear
 * between them, none beyond. efficiency: [count] fraction of photons that are recorded, 0 to 1; NULL:
 * recorded energy / energy. */
SKG_API skg_status skg_response_create_table(int64_t count, const double *energies_kev,
                                             const double *recorded_kev, const double *efficiency,
                                             skg_response **response);

/* From a text file of two columns, both in the unit ("eV", "keV", "MeV"). SKG_ERR_FILE, SKG_ERR_FORMAT. */
SKG_API skg_status skg_response_load(const char *path, const char *unit, skg_response **response);

/* A scintillator of `mm` thickness, its material at `packing` (0 < packing <= 1; needles of CsI 0.75 to 0.85)
 * of its density: R = E (1 - exp(-mu t)). An upper bound: every photon that interacts is fully absorbed, no
 * fluorescence escapes. */
SKG_API skg_status skg_response_create_scintillator(const skg_material *material, double mm, double packing,
                                                    skg_response **response);

/* The same by mass per area in mg/cm2. */
SKG_API skg_status skg_response_create_screen(const skg_material *material, double mg_cm2,
                                              skg_response **response);

SKG_API skg_status skg_response_retain(skg_response *response);
SKG_API void skg_response_release(skg_response **response);

/* Mean recorded energy in keV and recorded fraction of photons (either may be NULL) at an energy; oblique:
 * path through the layer / its thickness, >= 1, of which tables take no note. */
SKG_API skg_status skg_response_get(const skg_response *response, double energy_kev, double oblique,
                                    double *recorded_kev, double *efficiency);

#ifdef __cplusplus
}
#endif
#endif
