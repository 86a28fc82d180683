/* Everything that is found once, at rest. Private. */
#ifndef SKG_BODY_LINK_H
#define SKG_BODY_LINK_H

#include "body/types.h"

/* Axes of ribs, carriers, and the chains of deformable organs with their drivers. */
skg_status skg_body_find_links(skg_body *body);

/* Finds the links of deformable organs once more, after tissues, the tendon's plane or the reach of links were changed.
 * For a body that is linked. */
skg_status skg_body_find_links_again(skg_body *body);

/* Finds only how coupled organs follow ribs and dome, after one of the options for that was changed. */
skg_status skg_body_share_again(skg_body *body);

#endif
