/* The inside of a plan: known in this room alone. Private. */
#ifndef SKG_PLAN_PRIVATE_H
#define SKG_PLAN_PRIVATE_H

#include "plan/outcome.h"
#include "stage/machine.h"

struct skg_plan {
    skg_refs refs;
    skg_context *context; /* retained */
    skg_recipe *recipe;   /* replaced, never changed */
    skg_machine machine;
    skg_outcome outcome;
};

/* Makes a plan as skg_plan_create does, but tests nothing. */
skg_status skg_plan_make(skg_context *context, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                         const skg_plan_options *options, skg_plan **plan);

/* Checks that the scene still has the parts that the plan was made for, in the same places: else SKG_STALE. Takes over
 * materials that have changed. */
skg_status skg_plan_renew(skg_plan *plan);

#endif
