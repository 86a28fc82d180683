/* How much of an absolute beam a view receives. Private. */
#ifndef SKG_EXPOSURE_H
#define SKG_EXPOSURE_H

#include "core/core.h"

#include <skiagraph/scene.h>

/* The microsteradians of a pixel at the foot of the perpendicular from the source to the plane of the detector: what the
 * photons of an absolute spectrum are multiplied by. 1 for a parallel beam, which has no distance. */
double skg_view_exposure(const skg_view *view);

#endif
