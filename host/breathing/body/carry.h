/* Organs that are carried by others, vertex by vertex. Private. */
#ifndef SKG_CARRY_H
#define SKG_CARRY_H

#include "body/types.h"

/* Finds what carries an organ of ROLE_CARRIED, ROLE_SPANNED or ROLE_NEEDLE, of ROLE_CARTILAGE, or of no role
 * (ROLE_STATIC, which may become ROLE_CARRIED). Where that is not in the body, the organ becomes static, with a
 * warning. */
skg_status skg_carry_follow(skg_body *body, skg_body_organ *organ);
skg_status skg_carry_cartilage(skg_body *body, skg_body_organ *organ);
skg_status skg_carry_adopt(skg_body *body, skg_body_organ *organ);

#endif
