/* What is reported of finished work: times, bad pixels, negative exponents, lengths outside the verified range. Private. */
#ifndef SKG_REPORT_H
#define SKG_REPORT_H

#include "plan/outcome.h"
#include "stage/leaky.h"

/* What the device leaves of work, in staged memory. */
typedef struct {
    /* [3] pixels with a negative exponent in the last frame; in any frame, pixels outside the range and infinite values */
    int32_t *negative;
    int32_t *listed; /* [2] of the last frame, as skg_raster_read_listed leaves it */
    int64_t frames;
    int32_t
        *bad_vertex; /* [frames] the lowest vertex, over all parts, that was not finite; INT32_MAX: none */
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
