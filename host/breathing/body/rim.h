/* The diaphragm from its rim to its tendon. Private. */
#ifndef SKG_RIM_H
#define SKG_RIM_H

#include "body/types.h"

/* Finds how far each vertex of the diaphragm is from the rim. */
skg_status skg_rim_find(const skg_body *body, skg_body_organ *diaphragm);

/* Sets its share of the dome's motion from that: 0 at the rim, growing along the muscle, 1 in the tendon. */
void skg_rim_share(const skg_body *body, skg_body_organ *diaphragm);

#endif
