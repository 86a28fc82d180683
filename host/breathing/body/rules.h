/* Which vertices of a deformable organ are driven, by the rule of its label. Private. */
#ifndef SKG_RULES_H
#define SKG_RULES_H

#include "body/types.h"

/* Whether a point of an organ is driven, and by what. */
typedef int (*skg_link_rule)(const skg_body *body, const skg_body_organ *organ, const double p[3],
                             skg_link *link);

skg_link_rule skg_link_rule_of(const skg_body_organ *organ);

/* How far the diaphragm's links reach, mm. */
double skg_diaphragm_ribs_reach(const skg_body_options *options);
double skg_diaphragm_liver_reach(const skg_body_options *options);

/* The plane of the tendon, where the options have none. */
void skg_body_set_tendon_plane(skg_body *body);

#endif
