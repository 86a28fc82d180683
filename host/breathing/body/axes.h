/* Axes from the shapes of bones. Private. */
#ifndef SKG_AXES_H
#define SKG_AXES_H

#include "body/types.h"

/* Head of a rib, and direction (length 1) from there to its tubercle, by the vertebrae of the body; 0: its vertebra
 * is not in the body. */
int skg_rib_bone_axis(const skg_body *body, const skg_body_organ *rib, double head[3], double along[3]);

/* Principal axes of the surface's inertia (rows of length 1, the axis of most spread first), and the posterior end of
 * the first; of a rib, the end nearer to the spine. */
void skg_inertia_axes(const skg_body_organ *organ, double axes[9], double end[3]);

#endif
