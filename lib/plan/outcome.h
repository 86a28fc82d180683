/* What a plan reports: decisions, effects with reasons, overlaps, times, and which warnings were given already. Private. */
#ifndef SKG_OUTCOME_H
#define SKG_OUTCOME_H

#include "geometry/overlap.h"
#include "plan/effect.h"

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
    int32_t side; /* passes of a frame that a worker draws side by side; 0: all workers are at each pass */
    int32_t *
        warned_bad; /* [leaky parts] digits of the greatest number of bad pixels that was warned of; 0: none */
} skg_outcome;

/* Starts an outcome with what the recipe has decided. */
skg_status skg_outcome_create(const skg_recipe *recipe, skg_outcome *outcome);
void skg_outcome_release(skg_outcome *outcome);

/* Takes over what another recipe has decided differently: planes and accumulators. */
void skg_outcome_renew(const skg_recipe *recipe, skg_outcome *outcome);

#endif
