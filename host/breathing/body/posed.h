/* A body as it is posed: boxes that turn with the drivers, drivers that contradict each other, and measures. Private. */
#ifndef SKG_BODY_POSED_H
#define SKG_BODY_POSED_H

#include "body/types.h"

#include <skiagraph/breathing.h>

/* Boxes that turn with the drivers. The boxes of Chain Mail lie along the axes of space, so an organ that turned as a
 * whole would be squeezed and sheared by them, by several mm at 15 degrees. Where all drivers of an organ sit on
 * bones, the boxes turn with the rigid motion that is nearest to the drivers' (the rotation is the polar factor of
 * their covariance), and Chain Mail moves only what departs from it. */

/* Whether the boxes of an organ turn: not where a link ends at rest or in the tendon, or follows only in part, as
 * such links hold the organ in place. */
int skg_corotates(const skg_body *body, const skg_body_organ *organ);

/* The rigid motion nearest to that of the drivers; 0: no driver moves. */
int skg_corotate_motion(const skg_body_organ *organ, skg_rigid *motion);

/* Takes the rigid motion off a displacement u of the point `rest`, in axes that turn with it; and adds it again. */
void skg_corotate_remove(const skg_rigid *motion, const double rest[3], const double u[3], double v[3]);
void skg_corotate_restore(const skg_rigid *motion, const double rest[3], const double v[3], double u[3]);

/* Names of the two organs that contradict each other most in an organ as posed; NULL, NULL: no conflict. */
void skg_conflict_partners(const skg_body *body, const skg_body_organ *organ, const char *between[2]);

/* Warns of conflicts of more than 1 mm, once for each organ. */
void skg_body_warn_conflicts(skg_body *body);

/* Measures of a pose that motion needs too. */

/* V0/V of the lungs; 1 where there is none. */
double skg_body_lung_ratio(const skg_body *body);

/* Depth of the needle's tip below the skin, as its mesh has it, mm; NaN: no needle. */
double skg_body_needle_depth(const skg_body *body);

#endif
