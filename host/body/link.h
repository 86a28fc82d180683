/* Everything that is found once, at rest. Private. */
#ifndef SKG_BODY_LINK_H
#define SKG_BODY_LINK_H

#include "body/types.h"

/* Axes of ribs, carriers, and the chains of deformable organs with their drivers. */
skg_status skg_body_find_links(skg_body *body);

#endif
