/* The inside of a plan: known in this room alone. Private. */
#ifndef SKG_PLAN_PRIVATE_H
#define SKG_PLAN_PRIVATE_H

#include "frame/caller.h"
#include "plan/results.h"
#include "scatter/scatterer.h"
#include "stage/machine.h"

struct skg_plan {
    skg_refs refs;
    skg_context *context; /* retained */
    skg_recipe *recipe;   /* replaced, never changed */
    skg_machine machine;
    skg_outcome outcome;
    skg_scatterer scatterer;
};

/* Makes sure that the device has passed the self-tests of the kernels that the plan uses (self_tests.c). */
skg_status skg_plan_self_test(const skg_plan *plan, const skg_view *view);

/* Checks that the scene still has the parts that the plan was made for, in the same places: else SKG_STALE. Takes over
 * materials that have changed. */
skg_status skg_plan_renew(skg_plan *plan);

#endif
