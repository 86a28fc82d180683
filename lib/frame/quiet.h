/* Access to a plan for scans and for flat and dark fields, beyond its public interface. Private. */
#ifndef SKG_QUIET_H
#define SKG_QUIET_H

#include "core/context.h"

#include <skiagraph/types.h>

/* skg_call_begin for a plan's context. plan: NULL has no handler. */
skg_call skg_plan_call_begin(const skg_plan *plan);

/* Sets whether the plan has already warned that nothing falls on the detector, and returns whether it had. */
int32_t skg_plan_warned_unseen_set(skg_plan *plan, int32_t warned);

/* The value of a plan's images without radiation, in their unit. Noise and steps of an attenuation are 0: its logarithm has no value
 * there. */
typedef struct {
    double sigma, step; /* standard deviation of the electronic noise; the steps */
    int64_t noise_seed;
} skg_darkness;

skg_darkness skg_plan_darkness(const skg_plan *plan);

#endif
