/* How far the tendon goes at each place: both domes, and the back, farther than its middle. Private. */
#ifndef SKG_DOME_MOTION_H
#define SKG_DOME_MOTION_H

#include "body/types.h"

/* The displacement of the tendon at weight 1 over or under a point, mm. Everywhere tendon_mm, if nothing else is asked for or
 * the diaphragm is not coupled. */
void skg_dome_motion(const skg_body *body, const double p[3], double motion[3]);

#endif
