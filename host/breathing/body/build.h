/* Everything of a body that is found once, at rest: its organs, what carries them, and their chains. Private. */
#ifndef SKG_BODY_BUILD_H
#define SKG_BODY_BUILD_H

#include "body/types.h"

/* Copies and checks; on a failure the caller frees what is there. */
skg_status skg_body_fill_organ(const skg_organ *given, skg_body_organ *organ);

/* Organs that are carried by others, vertex by vertex. */

/* Finds what carries an organ of ROLE_CARRIED, ROLE_SPANNED or ROLE_NEEDLE, of ROLE_CARTILAGE, or of no role
 * (ROLE_STATIC, which may become ROLE_CARRIED). Where that is not in the body, the organ becomes static, with a
 * warning. */
skg_status skg_carry_follow(skg_body *body, skg_body_organ *organ);
skg_status skg_carry_cartilage(skg_body *body, skg_body_organ *organ);
skg_status skg_carry_adopt(skg_body *body, skg_body_organ *organ);

/* The chain of a deformable organ, with its drivers. */

/* Makes an organ's chain, and finds its drivers by the caller's links or the label's rule. */
skg_status skg_body_make_chain(skg_body *body, skg_body_organ *organ);

/* Frees them, also those that a failed call left. */
void skg_body_drop_chain(skg_body_organ *organ);

/* Axes of ribs, carriers, and the chains of deformable organs with their drivers. */
skg_status skg_body_find_links(skg_body *body);

/* Finds the links of deformable organs once more, after tissues, the tendon's plane or the reach of links were changed.
 * For a body that is linked. */
skg_status skg_body_find_links_again(skg_body *body);

/* Finds only how coupled organs follow ribs and dome, after one of the options for that was changed. */
skg_status skg_body_share_again(skg_body *body);

#endif
