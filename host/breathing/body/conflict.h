/* Drivers that contradict each other. Private. */
#ifndef SKG_CONFLICT_H
#define SKG_CONFLICT_H

#include "body/types.h"

/* Names of the two organs that contradict each other most in an organ as posed; NULL, NULL: no conflict. */
void skg_conflict_partners(const skg_body *body, const skg_body_organ *organ, const char *between[2]);

/* Warns of conflicts of more than 1 mm, once for each organ. */
void skg_body_warn_conflicts(skg_body *body);

#endif
