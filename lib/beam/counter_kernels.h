/* Sharing of counts between neighbouring pixels for a beam. Private. */
#ifndef SKG_COUNTER_KERNELS_H
#define SKG_COUNTER_KERNELS_H

#include "beam/counter.h"
#include "beam/spectrum.h"

/* Weights by which images of counts are convolved. Photons that count in several pixels make the noise of these alike: the weights of the
 * noise, over all windows, are the root of the covariance at each spatial frequency, of the beam without parts. */
typedef struct {
    int32_t windows;
    int32_t reach; /* tables are squares of 2 reach + 1 pixels */
    double *means; /* [windows][square], each with the sum 1 */
    double *noise; /* [to][from][square]: of deviations that are independent, with the means as variances */
    /* 0: pulses are not moved; otherwise the lowest step of their heights, and behind the noise there are */
    int32_t first;
    int32_t reserved;
    /* [windows][SKG_PULSE_STEPS] of pile_up.clh, and [windows][SKG_PULSE_STEPS] heights of the open beam */
    double *below;
} skg_counter_kernels;

/* Doubles of all tables, which follow each other from `means` on. */
static inline int64_t skg_counter_kernels_size(const skg_counter_kernels *kernels) {
    const int64_t side = 2 * kernels->reach + 1, windows = kernels->windows;
    return windows * (1 + windows) * side * side + (kernels->first ? 2 * windows * SKG_PULSE_STEPS : 0);
}

skg_status skg_counter_kernels_make(skg_counter *counter, const skg_spectrum *spectrum,
                                    skg_counter_kernels *kernels);
void skg_counter_kernels_release(skg_counter_kernels *kernels);

#endif
