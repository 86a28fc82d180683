/* Boxes that turn with the drivers. The boxes of Chain Mail lie along the axes of space, so an organ that turned as a
 * whole would be squeezed and sheared by them, by several mm at 15 degrees. Where all drivers of an organ sit on
 * bones, the boxes turn with the rigid motion that is nearest to the drivers' (the rotation is the polar factor of
 * their covariance), and Chain Mail moves only what departs from it. Private. */
#ifndef SKG_COROTATE_H
#define SKG_COROTATE_H

#include "body/types.h"

/* Whether the boxes of an organ turn: not where a link ends at rest or in the tendon, or follows only in part, as
 * such links hold the organ in place. */
int skg_corotates(const skg_body *body, const skg_body_organ *organ);

/* The rigid motion nearest to that of the drivers; 0: no driver moves. */
int skg_corotate_motion(const skg_body_organ *organ, skg_rigid *motion);

/* What a displacement u of the point `rest` has beyond the rigid motion, in axes that turn with it; and back. */
void skg_corotate_remove(const skg_rigid *motion, const double rest[3], const double u[3], double v[3]);
void skg_corotate_restore(const skg_rigid *motion, const double rest[3], const double v[3], double u[3]);

#endif
