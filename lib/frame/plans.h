/* The inside of a plan, known in this room and above in lib alone, and how it is made. Private. */
#ifndef SKG_PLANS_H
#define SKG_PLANS_H

#include "plan/recipe.h"
#include "plan/results.h"
#include "scatter/scatterer.h"
#include "stage/machine.h"

/* --- The inside of a plan: known in this room alone */

struct skg_plan {
    skg_refs refs;
    skg_context *context; /* retained */
    skg_recipe *recipe;   /* replaced, never changed */
    skg_machine machine;
    skg_outcome outcome;
    skg_scatterer scatterer;
};

/* Checks that the scene still has the parts that the plan was made for, in the same places: else SKG_STALE. Takes over
 * materials that have changed. */
skg_status skg_plan_renew(skg_plan *plan);

/* --- Makes a machine for a recipe */

/* Allocates on the device and uploads what does not move. blur: the caller's, read here; NULL: none. The machine must
 * not move afterwards. */
skg_status skg_machine_assemble(skg_context *context, const skg_recipe *recipe,
                                const skg_plan_options *options, skg_machine *machine);

/* Uploads what follows from the nodes of a complete recipe. */
skg_status skg_machine_complete(const skg_recipe *recipe, skg_machine *machine);

/* Takes over another recipe's model. After a failure the machine is as it was. */
skg_status skg_machine_renew(const skg_recipe *recipe, skg_machine *machine);

/* --- Adaptive sampling of an extended source */

/* If the number of source samples is not given: doubles it until two doublings in a row change less than the tolerance at
 * the recipe's view (docs/numerics.md), and returns a recipe with that number; else returns the recipe that was given,
 * retained. Warns if more samples would be needed than are allowed. Reports the samples and the last change. */
skg_status skg_samples_adapt(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome,
                             skg_recipe **adapted);

#endif
