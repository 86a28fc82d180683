/* The diaphragm from its rim to its tendon. Private. */
#ifndef SKG_RIM_H
#define SKG_RIM_H

#include "body/types.h"

/* Sets the diaphragm's share of the dome's motion: 0 at the rim, growing along the muscle, 1 in the tendon. */
skg_status skg_rim_share(const skg_body *body, skg_body_organ *diaphragm);

#endif
