/* Makes a machine for a recipe. Private. */
#ifndef SKG_ASSEMBLE_H
#define SKG_ASSEMBLE_H

#include "plan/recipe.h"
#include "stage/machine.h"

/* Allocates on the device and uploads what does not move. blur: the caller's, read here; NULL: none. The machine must
 * not move afterwards. */
skg_status skg_machine_assemble(skg_context *context, const skg_recipe *recipe,
                                const skg_plan_options *options, skg_machine *machine);

/* Uploads what follows from the nodes of a complete recipe. */
skg_status skg_machine_complete(const skg_recipe *recipe, skg_machine *machine);

/* Takes over another recipe's model. After a failure the machine is as it was. */
skg_status skg_machine_renew(const skg_recipe *recipe, skg_machine *machine);

#endif
