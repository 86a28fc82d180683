/** @file
 * Beams: how many photons of which energy would reach a pixel if nothing were in the way, and what the
 * detector records of them.
 *
 * The photons of a spectrum are those of a pixel, unless the spectrum is absolute: then they are photons per
 * microsteradian at the source, that is, per mm2 at a distance of 1 m. Absolute are the spectra of tubes with a
 * load (skg_tube.mas), those of skg_spectrum_create_absolute, and what is made of these by filters and factors. A
 * plan finds out from its view how many of these photons a pixel receives.
 *
 * A spectrum or response never changes and may be shared by threads. Functions that make one return
 * SKG_ERR_BEAM unless they say otherwise; the caller releases the result. Energies are 1 keV to 20 MeV.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BEAM_H
#define SKIAGRAPH_BEAM_H

#include <skiagraph/context.h>
#include <skiagraph/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Photons by energy. */
typedef struct skg_spectrum skg_spectrum;

/** Makes a spectrum of one energy.
 *
 *     energy_kev   keV
 *     photons      per pixel, finite, above 0 */
SKG_API skg_status skg_spectrum_create_mono(double energy_kev, double photons, skg_spectrum **spectrum);

/** Makes a spectrum from bins.
 *
 *     count          number of bins, at least 1
 *     energies_kev   [count] keV, in any order; bins of equal energy are added
 *     photons        [count] per pixel, finite, at least 0, not all 0; bins without photons are dropped */
SKG_API skg_status skg_spectrum_create_bins(int64_t count, const double *energies_kev, const double *photons,
                                            skg_spectrum **spectrum);

/** Makes a spectrum from a file: text with two columns, energy and photons per pixel, in which lines that
 * begin with # are skipped; or a GATE macro, of which the lines with "histpoint" or "hist/point" are read.
 *
 *     unit     of the energies: "eV", "keV" or "MeV"
 *     errors   SKG_ERR_FILE; SKG_ERR_FORMAT with the line */
SKG_API skg_status skg_spectrum_load(const char *path, const char *unit, skg_spectrum **spectrum);

/** A layer of matter that the whole beam crosses. Prepare with skg_filter_init. */
typedef struct {
    /** Set by skg_filter_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Material of known density. Not retained. */
    const skg_material *material;
    /** mm, at least 0 */
    double thickness_mm;
} skg_filter;

SKG_INIT(skg_filter)

/** Makes the spectrum behind filters. Energies that keep less than 1e-9 of the photons of the strongest one
 * are dropped.
 *
 *     filters   [count] the layers; NULL if count is 0
 *     errors    also SKG_ERR_MATERIAL if a density is unknown */
SKG_API skg_status skg_spectrum_create_filtered(const skg_spectrum *spectrum, int64_t count,
                                                const skg_filter *filters, skg_spectrum **behind);

/** Makes a spectrum with all photon numbers multiplied by a factor, finite and above 0. */
SKG_API skg_status skg_spectrum_create_scaled(const skg_spectrum *spectrum, double factor,
                                              skg_spectrum **scaled);

/** Makes an absolute spectrum: the photons of `spectrum` are taken as photons per microsteradian at the source, that
 * is, per mm2 at a distance of 1 m. */
SKG_API skg_status skg_spectrum_create_absolute(const skg_spectrum *spectrum, skg_spectrum **absolute);

/** Gets whether a spectrum is absolute.
 *
 *     absolute   result: 1 if photons are per microsteradian at the source, 0 if they are per pixel */
SKG_API skg_status skg_spectrum_absolute_get(const skg_spectrum *spectrum, int32_t *absolute);

/** Models of the spectrum of an X-ray tube. Both have the same characteristic lines and the same output. */
enum skg_tube_model {
    /** H. Ebel, X-Ray Spectrom. 28 (1999) 255: continuum and lines of a reflection target, calibrated. */
    SKG_TUBE_MODEL_EBEL = 0,
    /** R. Birch and M. Marshall, Phys. Med. Biol. 24 (1979) 505: the continuum that the paper uses. It is calibrated
     * as Ebel's is, and has the same lines. */
    SKG_TUBE_MODEL_BIRCH = 1
};

/** An X-ray tube. Prepare with skg_tube_init; set kvp.
 *
 * Continuum, K lines and L lines of tungsten, molybdenum and rhodium are calibrated with SpekPy 2.5. Behind
 * 2.5 mm Al, with tungsten at 12 degrees, air kerma at 1 m is within 2 % of 48.9, 82.0, 118.9, 158.7 and
 * 222.8 uGy/mAs at 60, 80, 100, 120 and 150 kV, and the first half-value layer within 1 % of 2.082, 2.734,
 * 3.458, 4.219 and 5.372 mm Al; from 160 to 300 kV, behind 2.5 mm Al and 0.5 and 2 mm Cu, air kerma is within 2 % and first
 * half-value layers in Al and Cu within 1.5 % of SpekPy's at 12 degrees (3 % at 20 degrees); from 300 to 400 kV they change as xpecgen's
 * do, which is no measurement; beyond nothing is verified;
 * behind 0.5 mm Al at 25 to 40 kV both are within 5 %; mammographic beams (Mo/Mo,
 * Mo/Rh, Rh/Rh, W/Rh, W/Ag) are within 2 %. First half-value layers that PTB measured are reproduced within 3 %.
 * A tube outside the range of the calibration is reported as a warning: other voltages and angles, other
 * anodes, and filters so thin that more than 1 % of the air kerma is that of photons below 7 keV. No
 * inherent filtration is assumed; from 70 kV on, a beam softer than behind 2.5 mm Al (IEC 60601-1-3) is
 * reported as a warning. */
typedef struct {
    /** Set by skg_tube_init. */
    int32_t size;
    /** enum skg_tube_model; SKG_TUBE_MODEL_EBEL by default */
    int32_t model;
    /** Tube voltage in kV, 10 to 450; validated from 20 to 300 with W, from 20 to 49 with Mo and Rh. */
    double kvp;
    /** Angle between the anode's face and the central ray, degrees, 3 to 60; 12 by default. Validated from 6 to
     * 20 with W, from 12 to 20 with Mo and Rh. */
    double angle_deg;
    /** Atomic number of the anode, 20 to 92; 74 by default. Validated are 74, 42 and 45. */
    int32_t anode;
    /** 0 */
    int32_t reserved;
    /** Width of a bin in keV, 0.1 to 10; 1 by default. Energies are the middles of the bins. */
    double bin_kev;
    /** Tube load: current times time in mAs. Above 0, the spectrum is absolute. 0 (default): the load is not known;
     * the spectrum has the photons that 1 mAs sends to a mm2 at 1 m, and counts them as photons of a pixel. */
    double mas;
    /** With pixel_mm2: from the focal spot to the pixel, mm; see there. 0 by default. */
    double distance_mm;
    /** 0 (default): the plan finds out from its view what a pixel receives. Above 0, which needs mas and
     * distance_mm: photons are those of a pixel of this area in mm2 at this distance, and the spectrum is not
     * absolute. */
    double pixel_mm2;
    /** Measured air kerma per mAs behind the filters, uGy/mAs, instead of the model's; 0: the model's. */
    double output_ugy_mas;
    /** Distance at which output_ugy_mas was measured, mm; 1000 by default. */
    double output_at_mm;
    /** Number of filters. */
    int64_t filter_count;
    /** [filter_count] all layers in the beam: inherent filtration, added filters, air. */
    const skg_filter *filters;
    /** Receives warnings in its log; may be NULL. */
    skg_context *context;
    /** Receives the warnings if context is NULL; may be NULL. */
    skg_log_function log;
    /** Passed to log. */
    void *log_user;
} skg_tube;

SKG_INIT(skg_tube)

/** Makes the spectrum of a tube. */
SKG_API skg_status skg_spectrum_create_tube(const skg_tube *tube, skg_spectrum **spectrum);

/** Adds an owner to a spectrum. */
SKG_API skg_status skg_spectrum_retain(skg_spectrum *spectrum);

/** Removes an owner; the last one frees the spectrum. */
SKG_API void skg_spectrum_release(skg_spectrum **spectrum);

/** Number of energies in a spectrum. */
SKG_API skg_status skg_spectrum_bin_count(const skg_spectrum *spectrum, int64_t *count);

/** Gets energy 0 <= index < count in keV, in rising order, and its photons: per pixel, or per microsteradian if the
 * spectrum is absolute. */
SKG_API skg_status skg_spectrum_bin_get(const skg_spectrum *spectrum, int64_t index, double *energy_kev,
                                        double *photons);

/** Figures of a beam's quality. The library fills it; prepare with skg_quality_init.
 *
 * Half-value layers are of air kerma. Its energy-transfer coefficient is photo absorption plus free
 * Klein-Nishina plus pairs, which is 0.6 % above NIST's mu_en/rho at 10 keV and 0.2 % at 80 keV. */
typedef struct {
    /** Set by skg_quality_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Photons, per pixel or per microsteradian as the spectrum's. */
    double photons;
    /** Energy of all photons together, keV. */
    double energy_kev;
    /** Mean energy of a photon, keV. */
    double mean_kev;
    /** First half-value layer, mm of aluminium. */
    double hvl1_mm_al;
    /** Second half-value layer, mm of aluminium. */
    double hvl2_mm_al;
    /** First half-value layer, mm of copper. */
    double hvl1_mm_cu;
    /** Second half-value layer, mm of copper. */
    double hvl2_mm_cu;
    /** First over second half-value layer in aluminium. */
    double homogeneity;
    /** Air kerma in uGy, if photons are per mm2. That of an absolute spectrum is at 1 m. */
    double air_kerma_ugy;
} skg_quality;

SKG_INIT(skg_quality)

/** Gets the figures of a beam's quality. */
SKG_API skg_status skg_spectrum_quality_get(const skg_spectrum *spectrum, skg_quality *quality);

/** Recorded energy of a photon and the probability that it is recorded, by its energy. Where a response may be NULL, NULL is the
 * ideal detector: it records every photon with all its energy. */
typedef struct skg_response skg_response;

/** How noise is computed from the recorded energies of a table. Means are the same for both. */
enum skg_response_meaning {
    /** The mean signal of a photon that arrives, in units of the energy that would give it. The share of the
     * photons that give any signal is the table's efficiency; without one, every photon does. */
    SKG_RESPONSE_MEANING_SIGNAL = 0,
    /** The mean energy that a photon leaves in the detector, where it leaves either all or nothing: the share
     * of the photons that are recorded is the recorded energy divided by the photon's own. */
    SKG_RESPONSE_MEANING_ABSORBED = 1
};

/** A response by energy. Prepare with skg_response_table_init; set count and the first two arrays.
 *
 * Of the photons that arrive the share `efficiency` is recorded; the signals of these have the mean
 * recorded_kev / efficiency and a mean square of the square of this over `swank`. A number N of photons that
 * arrive gives a signal with the mean N recorded_kev and the variance
 * N recorded_kev^2 / (efficiency swank). */
typedef struct {
    /** Set by skg_response_table_init. */
    int32_t size;
    /** enum skg_response_meaning */
    int32_t meaning;
    /** Number of energies, at least 2. */
    int64_t count;
    /** [count] keV, rising */
    const double *energies_kev;
    /** [count] mean recorded energy of a photon that arrives, keV, 0 to its own energy */
    const double *recorded_kev;
    /** [count] share of the photons that are recorded, 0 to 1, above 0 where recorded_kev is; NULL: 1 with
     * SKG_RESPONSE_MEANING_SIGNAL. NULL with SKG_RESPONSE_MEANING_ABSORBED. */
    const double *efficiency;
    /** [count] Swank factor of the signals of recorded photons, above 0 to 1; NULL: 1 */
    const double *swank;
} skg_response_table;

SKG_INIT(skg_response_table)

/** Makes a response from a table.
 *
 *     table    its arrays are copied
 *     method   linear interpolation; no values beyond the ends */
SKG_API skg_status skg_response_create_table(const skg_response_table *table, skg_response **response);

/** Makes a response from pulse-height distributions: how often a photon of an energy gives a pulse of a height.
 *
 *     count          number of energies, at least 2
 *     energies_kev   [count] keV, rising
 *     heights        number of heights, at least 1
 *     height_kev     [heights] keV, above 0, rising
 *     probability    [count][heights] at least 0; a row sums to at most 1, and the rest gives no pulse
 *     method         recorded energy, efficiency and Swank factor are the moments of a row: with sums over
 *                    heights h of probability p, they are sum(p h), sum(p) and sum(p h)^2 / (sum(p) sum(p h^2)).
 *                    Linear interpolation of these between the energies. */
SKG_API skg_status skg_response_create_pulses(int64_t count, const double *energies_kev, int64_t heights,
                                              const double *height_kev, const double *probability,
                                              skg_response **response);

/** Makes a response from a text file with two to four columns: energy, mean recorded energy, efficiency, Swank
 * factor.
 *
 *     unit      of the first two columns: "eV", "keV" or "MeV"
 *     meaning   enum skg_response_meaning
 *     errors    SKG_ERR_FILE; SKG_ERR_FORMAT with the line */
SKG_API skg_status skg_response_load(const char *path, const char *unit, int32_t meaning,
                                     skg_response **response);

/** Makes the response of a scintillator of a given thickness.
 *
 *     thickness_mm   mm
 *     packing        fraction of the material's density that the layer has, above 0 to 1; needles of CsI have
 *                    0.75 to 0.85
 *     method         R = E (1 - exp(-mu t)): every photon that interacts is fully absorbed and no
 *                    fluorescence escapes, so this is an upper bound; skg_response_create_transporting and
 *                    skg_response_create_escaping make it lower */
SKG_API skg_status skg_response_create_scintillator(const skg_material *material, double thickness_mm,
                                                    double packing, skg_response **response);

/** Makes the response of a scintillator of a given mass per area in mg/cm2. */
SKG_API skg_status skg_response_create_screen(const skg_material *material, double mg_cm2,
                                              skg_response **response);

/** Makes the response of a scintillator from which K fluorescence escapes.
 *
 *     scintillator   response of skg_response_create_scintillator or _screen; it does not change
 *     method         Above the K edge of an element, absorption mostly leaves a vacancy that emits a photon of the
 *                    element's K lines, of which some leave the layer. The recorded energy is less by their mean
 *                    energy, and the Swank factor is that of the pulse heights E and E - E(line). Photons that are
 *                    absorbed again may be followed by further ones (Te by Cd). Yields, lines and jumps are those
 *                    of the tables of elements from Z = 20 on. Scattered photons count as absorbed, and light of
 *                    the layer is not considered.
 *     errors         SKG_ERR_BEAM if the response is a table; SKG_ERR_MATERIAL if the composition is unknown */
SKG_API skg_status skg_response_create_escaping(const skg_response *scintillator, skg_response **response);

/** Makes the response of a scintillator in which scattered photons are followed: Compton scattering leaves the energy of the electron,
 * and the scattered photon, as after Rayleigh scattering, is absorbed elsewhere or lost.
 *
 * of 600 um CsI (packing 0.8) it leaves 0.96 of the energy of photons that interact at 80 keV, 0.85 at 150, 0.50 at 450 keV.
 *
 *     scintillator   response of skg_response_create_scintillator, _screen or _escaping; it does not change
 *     method         An integral equation of photon transport in the layer, solved once by energy, depth and direction: mean and mean
 *                    square, so that the Swank factor follows. Free atoms; electrons stay where they are set free. The efficiency
 *                    stays the share of the photons that interact, of which some leave nothing.
 *     errors         SKG_ERR_BEAM if the response is a table; SKG_ERR_MATERIAL if the composition is unknown */
SKG_API skg_status skg_response_create_transporting(const skg_response *scintillator,
                                                    skg_response **response);

/** Makes a response with a measured detective quantum efficiency at spatial frequency 0. What is recorded does not
 * change; the Swank factor becomes dqe / efficiency, both for photons that arrive straight.
 *
 *     response       of what is recorded; retained
 *     count          number of energies, at least 2
 *     energies_kev   [count] keV, rising; with noise, a beam with energies outside is refused
 *     dqe            [count] above 0, at most the efficiency of the response; linear between energies
 *     errors         SKG_ERR_BEAM */
SKG_API skg_status skg_response_create_dqe(skg_response *response, int64_t count, const double *energies_kev,
                                           const double *dqe, skg_response **measured);

/** Adds an owner to a response. */
SKG_API skg_status skg_response_retain(skg_response *response);

/** Removes an owner; the last one frees the response. */
SKG_API void skg_response_release(skg_response **response);

/** Gets what is recorded of a photon.
 *
 *     energy_kev     energy of the photon, keV
 *     oblique        path through the layer divided by its thickness, at least 1; tables do not depend on it
 *     recorded_kev   result: mean recorded energy, keV; may be NULL
 *     efficiency     result: fraction of the photons that are recorded; may be NULL */
SKG_API skg_status skg_response_get(const skg_response *response, double energy_kev, double oblique,
                                    double *recorded_kev, double *efficiency);

/** Gets the Swank factor of the signals of recorded photons: 1 if a recorded photon always gives the same
 * signal. Efficiency times Swank factor is the detective quantum efficiency at spatial frequency 0 for this
 * energy.
 *
 *     energy_kev   energy of the photon, keV
 *     oblique      as of skg_response_get
 *     swank        result: above 0 to 1 */
SKG_API skg_status skg_response_swank_get(const skg_response *response, double energy_kev, double oblique,
                                          double *swank);

#ifdef __cplusplus
}
#endif
#endif
