/* Copies of what a plan's options point to of heel, bow-tie, grid, depths and DQE. Private. */
#ifndef SKG_KEEP_H
#define SKG_KEEP_H

#include "core/core.h"

#include <skiagraph/options.h>

typedef struct {
    skg_heel heel;
    skg_bowtie bowtie;     /* its material retained, its arrays in rows */
    skg_grid grid;         /* its materials retained */
    double *rows;          /* [2][bowtie.count] */
    skg_depth_blur depths; /* without its blurs, which are read when the plan is made */
    double depth_ends[SKG_DEPTHS_MAX];
    skg_dqe dqe;
    double *frequencies; /* [2][dqe.count] */
} skg_kept;

/* Copies and checks what options point to, and makes them point to the copies. If it fails, they point to none of these. */
skg_status skg_keep(skg_plan_options *options, skg_kept *kept);
void skg_kept_release(skg_kept *kept);

#endif
