/** @file
 * Detectors that count photons: what a sensor with pixels and thresholds counts of each.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_COUNTING_H
#define SKIAGRAPH_COUNTING_H

#include <skiagraph/material.h>
#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Limits of a detector that counts. */
enum skg_counting_limit {
    /** Most thresholds. */
    SKG_THRESHOLDS_MAX = 8,
    /** How far from the pixel that a photon enters its counts are told apart, in pixels; those beyond count there. */
    SKG_COUNTING_REACH = 5,
    /** Pixels along a side of the tables of neighbours: 2 SKG_COUNTING_REACH + 1. */
    SKG_COUNTING_SIDE = 11
};

/** Models of pile-up: pulses that follow each other within the dead time. Overlapping pulses count in the window of their sum: with several
 * thresholds counts move to higher windows, while all together stay as below. A low window of a paralysable detector, the difference of two
 * counters, may be negative from about one pulse in a dead time on; skg_channel.flat_field is then 0. */
enum skg_pile_up {
    /** Every pulse counts. */
    SKG_PILE_UP_NONE = 0,
    /** For the dead time after a pulse that counted, no pulse counts: n pulses for each dead time leave n / (1 + n). */
    SKG_PILE_UP_NONPARALYSABLE = 1,
    /** For the dead time after any pulse, no pulse counts: n pulses for each dead time leave n exp(-n). */
    SKG_PILE_UP_PARALYSABLE = 2
};

/** A detector that counts photons by thresholds. Prepare with skg_counting_init; set material, thickness_mm, pixel_mm, count and
 * threshold_kev.
 *
 * Photons enter a plane sensor at right angles and interact in it. The charge drifts to the pixels on the far side, spreads on the way,
 * and each pixel compares what it gets with its thresholds. A photon may count in one pixel, in several, or in none.
 *
 * window      number c counts the pulses from threshold c up to below threshold c + 1; the last has no upper end
 * method      16384 histories of each energy, whose choices follow a lattice of points in place of random numbers: depth,
 *             place in the pixel, photo absorption with K fluorescence that is followed until it leaves the sensor, Compton scattering
 *             (Klein and Nishina, times the scattering functions of free atoms) whose photon may interact once more.
 *             For each history, the charge in each pixel and the chance that it passes a threshold are in closed form (error functions).
 * left out    Rayleigh scattering, L fluorescence, the range of electrons (cloud_mm may stand for it), repulsion and trapping of the
 *             charge, charge that pixels induce in each other, rays that enter obliquely */
typedef struct {
    /** Set by skg_counting_init. */
    int32_t size;
    /** enum skg_pile_up; the dead time begins with pulses above the lowest threshold. */
    int32_t pile_up;
    /** Material of the sensor, of known composition and density; retained. */
    skg_material *material;
    /** Thickness of the sensor, mm. */
    double thickness_mm;
    /** Pitch of the pixels along rows and along columns, mm. */
    double pixel_mm[2];
    /** Number of thresholds, 1 to SKG_THRESHOLDS_MAX. */
    int64_t count;
    /** [count] keV, rising; the lowest is at least 4 standard deviations of the electronic noise. */
    const double *threshold_kev;
    /** Standard deviation of a pixel's pulse by electronic noise, keV; 0 by default. */
    double electronic_kev;
    /** Standard deviation of the charge's cloud where it is set free, along each direction, mm; 0 by default. */
    double cloud_mm;
    /** V over the sensor, in an even field: on its way d to the pixels the cloud's variance grows by 2 (kT/e) d thickness / bias at 300 K
     * (diffusion). 0 (default): it does not. */
    double bias_v;
    /** 1: K fluorescence is followed. 0 (default): it stays where it is set free. */
    int32_t fluorescence;
    /** 1: anti-coincidence: the pixels of the 2 x 2 that together get most are summed, and the sum counts once, in the pixel that got
     * most; its noise is that of four pixels. */
    int32_t anti_coincidence;
    /** Dead time of a pixel, ns; needs pile_up and exposure_s. */
    double dead_time_ns;
    /** Time in which the photons of an image arrive, s. */
    double exposure_s;
} skg_counting;

SKG_INIT(skg_counting)

/** A detector that counts, with what it counts of the energies that were asked for. Threads may share it. */
typedef struct skg_counter skg_counter;

/** Makes a detector that counts.
 *
 *     errors   SKG_ERR_BEAM for dimensions and thresholds that cannot be used; SKG_ERR_MATERIAL if the composition or the density is
 *              not known */
SKG_API skg_status skg_counter_create(const skg_counting *counting, skg_counter **counter);

/** Adds an owner to a detector that counts. */
SKG_API skg_status skg_counter_retain(skg_counter *counter);

/** Removes an owner; the last one frees it. */
SKG_API void skg_counter_release(skg_counter **counter);

/** Gets the number of its thresholds. */
SKG_API skg_status skg_counter_thresholds_get(const skg_counter *counter, int64_t *count);

/** Gets what it counts of one photon, before pile-up.
 *
 *     energy_kev   of the photon, 1 to 1,022 keV
 *     counts       result: [thresholds] the mean number of counts in each window, in all pixels together
 *     errors       SKG_ERR_BEAM for an energy outside */
SKG_API skg_status skg_counter_counts_get(skg_counter *counter, double energy_kev, double *counts);

/** Gets where the counts of a photon of a window are that enters somewhere in a pixel.
 *
 *     spread   result: [SKG_COUNTING_SIDE][SKG_COUNTING_SIDE] mean counts by row and column, that pixel in the middle */
SKG_API skg_status skg_counter_spread_get(skg_counter *counter, double energy_kev, int64_t window,
                                          double *spread);

/** Gets how often one photon counts in two pixels, which is the covariance of their counts for each photon that enters a pixel.
 *
 *     window   of the first pixel
 *     other    of the second
 *     pairs    result: [SKG_COUNTING_SIDE][SKG_COUNTING_SIDE] mean number of pairs by the row and column of the second as seen from the
 *              first; in the middle, one pixel with itself: its counts if both windows are the same, otherwise 0 */
SKG_API skg_status skg_counter_pairs_get(skg_counter *counter, double energy_kev, int64_t window,
                                         int64_t other, double *pairs);

/** Gets what dead time leaves of pulses.
 *
 *     pile_up     enum skg_pile_up
 *     pulses      mean number in one dead time, at least 0
 *     counted     result: mean number of those that count
 *     fano        result: variance of the counts in a long time over their mean; may be NULL
 *     method      n / (1 + n) and n exp(-n); variances of renewal processes: 1 / (1 + n)^2 and 1 - 2 n exp(-n) (J. W. Mueller,
 *                 Nuclear Instruments and Methods 112 (1973) 47-57)
 *     errors      SKG_ERR_ARGUMENT */
SKG_API skg_status skg_pile_up_get(int32_t pile_up, double pulses, double *counted, double *fano);

#ifdef __cplusplus
}
#endif
#endif
