/* The warning that nothing falls on the detector. Private. */
#ifndef SKG_UNSEEN_H
#define SKG_UNSEEN_H

#include "geometry/extent.h"
#include "plan/outcome.h"

/* Warns, once, if no part falls on the detector: in which direction and how far away the nearest shadow lies. extents:
 * [parts] as the camera sees them; fine: its pixels along each side of a pixel of the image. */
void skg_warn_unseen(const skg_context *context, const skg_scene *scene, const skg_camera *camera,
                     const skg_extent *extents, int32_t fine, skg_outcome *outcome);

#endif
