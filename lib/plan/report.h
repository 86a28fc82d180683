/* What a plan tells: effects with reasons, overlaps, and after a job its stages and its bad pixels. Private.
 */
#ifndef SKG_REPORT_H
#define SKG_REPORT_H

#include "frame/plan.h"
#include "geometry/extent.h"

/* Fills the effects of a new plan. */
skg_status skg_report_effects(skg_plan *plan);

/* Estimates what the effects of a plan cost; extents: [parts], at its view (effect_costs.c). */
void skg_report_costs(skg_plan *plan, const skg_extent *extents);

/* Finds overlaps and warns of them, where asked for. */
skg_status skg_report_overlaps(skg_plan *plan);

/* A finished job: stage times, bad and negative pixels, with their warnings. */
skg_status skg_report_job(skg_job *job);

#endif
