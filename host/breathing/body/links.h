/* Links: which points drive a deformable organ, what moves these points, and how far. Private. */
#ifndef SKG_BODY_LINKS_H
#define SKG_BODY_LINKS_H

#include "body/types.h"

/* Finding organs, and the nearest points on them. */

/* The distance in mm from a point to the nearest point of an organ's triangles, and that point as corners and weights
 * of the link; HUGE_VAL where it is farther than `reach`. */
double skg_nearest(const skg_body_organ *organ, const double point[3], double reach, skg_link *link);

/* The first organ whose label begins with a word; -1: none. */
int32_t skg_find_organ(const skg_body *body, const char *word);

/* Which vertices of a deformable organ are driven, by the rule of its label. */

/* Whether a point of an organ is driven, and by what. */
typedef int (*skg_link_rule)(const skg_body *body, const skg_body_organ *organ, const double p[3],
                             skg_link *link);

skg_link_rule skg_link_rule_of(const skg_body_organ *organ);

/* How far the diaphragm's links reach, mm. */
double skg_diaphragm_ribs_reach(const skg_body_options *options);
double skg_diaphragm_liver_reach(const skg_body_options *options);

/* The plane of the tendon, where the options have none. */
void skg_body_set_tendon_plane(skg_body *body);

/* Links that the caller gives, instead of the rule of a label. */

/* Checks which organs the links go to, and sets the stages of all deformable organs. */
skg_status skg_body_check_ties(skg_body *body);

/* Makes a link move with its organ as a whole, from the point p at rest, if that organ is rigid. */
void skg_link_fix(const skg_body *body, const double p[3], skg_link *link);

/* The distance in mm from a point to the nearest organ of an organ's links, that place, and the link's rigid_mm;
 * HUGE_VAL where none is near enough. */
double skg_given_link(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link,
                      double *rigid);

/* Struts. Each face of a closed sheet is held to the other through its rim only, so every vertex of the diaphragm is
 * also linked to the nearest one of the face behind it. */

/* Adds struts to the links of an organ; the caller frees *ends. */
skg_status skg_body_add_struts(const skg_body_organ *organ, int64_t *links, int32_t **ends);

/* Displacements of points that follow other organs. */

/* The displacement of a link's end at the other organ. */
void skg_link_follow(const skg_body *body, const skg_link *link, double displacement[3]);

/* The displacement of a vertex of a carried organ or of the needle's tissue. */
void skg_carried_vertex(const skg_body *body, const skg_body_organ *organ, int64_t vertex,
                        double displacement[3]);

#endif
