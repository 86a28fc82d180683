/* Links that the caller gives, instead of the rule of a label. Private. */
#ifndef SKG_TIE_H
#define SKG_TIE_H

#include "body/types.h"

/* Checks which organs the links go to, and sets the stages of all deformable organs. */
skg_status skg_body_check_ties(skg_body *body);

/* Makes a link move with its organ as a whole, from the point p at rest, if that organ is rigid. */
void skg_link_fix(const skg_body *body, const double p[3], skg_link *link);

/* The distance in mm from a point to the nearest organ of an organ's links, that place, and the link's rigid_mm;
 * HUGE_VAL where none is near enough. */
double skg_given_link(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link,
                      double *rigid);

#endif
