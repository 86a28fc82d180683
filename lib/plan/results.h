/* The results of a plan beside images: its report and its outcome. Private. */
#ifndef SKG_RESULTS_H
#define SKG_RESULTS_H

#include "geometry/overlaps.h"
#include "plan/rules.h"
#include "stage/leaks.h"

/* --- Reports of a plan: decisions, effects with reasons, overlaps, times, and which warnings were given already */

/* Time of a stage in the last job. */
typedef struct {
    const char *name; /* static storage */
    double ns;
} skg_stage_time;
enum { SKG_STAGES_MAX = 32 };

typedef struct {
    skg_plan_report report;
    skg_effect_state effects[SKG_EFFECTS];
    int64_t overlap_side; /* columns along each side of the grid on which they were looked for */
    int64_t overlap_count;
    skg_overlap_pair *overlaps;
    int64_t stage_count;
    skg_stage_time stages[SKG_STAGES_MAX];
    int32_t warned_unseen;   /* 1: that nothing falls on the detector */
    int32_t warned_infinite; /* 1: that pixels were not finite */
    int32_t warned_wrapped;  /* 1: that sums left their bounds */
    int32_t side; /* passes of a frame that a worker draws side by side; 0: all workers are at each pass */
    /* [leaky parts] digits of the greatest number of bad pixels that was warned of; 0: none */
    int32_t *warned_bad;
} skg_outcome;

/* Starts an outcome with what the recipe has decided. */
skg_status skg_outcome_create(const skg_recipe *recipe, skg_outcome *outcome);
void skg_outcome_release(skg_outcome *outcome);

/* Takes over what another recipe has decided differently: planes and accumulators. */
void skg_outcome_renew(const skg_recipe *recipe, skg_outcome *outcome);

/* --- Reports of finished work: times, bad pixels, negative exponents, lengths outside the verified range */

/* The counts that the device leaves of work, in staged memory. */
typedef struct {
    /* [4] pixels with a negative exponent in the last frame; in any frame, pixels outside the range, infinite values, and rays
     * with a sum beyond its bound */
    int32_t *negative;
    int32_t *listed; /* [2] of the last frame, as skg_raster_read_listed leaves it */
    int64_t frames;
    /* [frames] the lowest vertex, over all parts, that was not finite; INT32_MAX: none */
    int32_t *bad_vertex;
    skg_leaky_verdicts leaky; /* of the last frame */
    /* [meshes] the lowest vertex of each mesh outside of the bounds that the caller gave with it; INT32_MAX: none, or none
     * were given. NULL: for no mesh */
    int32_t *outside;
} skg_results;

/* Reports finished work, with its warnings. SKG_ERR_MESH for a vertex that could not be projected; SKG_RANGE if the
 * error bound is not stated for the lengths that were met. */
skg_status skg_report_work(const skg_recipe *recipe, skg_context *context, const skg_geometry *geometry,
                           const skg_results *results, const skg_stage_log *log, skg_outcome *outcome);

#endif
