/* The refusals of scenes and frames that have no derivatives. Private. */
#ifndef SKG_GRADIENT_REFUSALS_H
#define SKG_GRADIENT_REFUSALS_H

#include "frame/plans.h"

#include <skiagraph/gradient.h>

/* Refuses by name what has no gradient of a frame by what is wanted, and attenuations for another number of energies than the plan's.
 * call: the name of the public function; frame: NULL: as plan and scene stand */
skg_status skg_gradient_check(const char *call, const skg_plan *plan, const skg_frame *frame,
                              const skg_gradient *wanted);

/* Refuses a volume of cells that moves along a direction, or whose attenuation coefficients change. The direction's number of nodes was
 * checked. */
skg_status skg_gradient_check_cells(const char *call, const skg_scene *scene, const skg_direction *direction);

#endif
