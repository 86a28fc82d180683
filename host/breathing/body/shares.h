/* How diaphragm, lungs, liver and the wall of the body follow ribs and dome together. Private.
 *
 * A vertex at p is displaced by s T + (1 - s) B(p). T is the displacement of the tendon, and B that of the bones around p.
 * The share s of the dome is 0 at the diaphragm's rim, which the ribs carry. It grows along the muscle, whose fibres shorten
 * by the same factor from end to end, and is 1 in the tendon. Lungs have the dome's share at their base and 0 at the upper
 * wall. The liver has that of the dome above it, and less or more farther down, so that it keeps its volume. */
#ifndef SKG_BODY_SHARES_H
#define SKG_BODY_SHARES_H

#include "body/types.h"

/* The share from which the diaphragm is dome, rather than the wall beside which organs slide: a choice. */
extern const double skg_dome_from;

/* Whether the options ask for that. */
int skg_is_anatomical(const skg_body *body);

/* Whether an organ moves so: by its label, in a body with ribs and, unless it is the wall, with a diaphragm. */
int skg_is_coupled(const skg_body *body, const skg_body_organ *organ);

/* Finds shares and bones. The diaphragm's come first. */
skg_status skg_share_find(const skg_body *body, skg_body_organ *organ);

/* Shares and courses once more, after the options have changed. */
skg_status skg_share_again(const skg_body *body, skg_body_organ *organ);

/* The displacements that the vertices of such an organ shall have: into moved. */
void skg_share_displace(const skg_body *body, skg_body_organ *organ);

/* How far the tendon goes at each place: both domes, and the back, farther than its middle. */

/* The displacement of the tendon at weight 1 over or under a point, mm. Everywhere tendon_mm, if nothing else is asked for or
 * the diaphragm is not coupled. */
void skg_dome_motion(const skg_body *body, const double p[3], double motion[3]);

/* The liver under the dome. */

/* Finds which vertices lie under the dome. */
skg_status skg_liver_find(const skg_body_organ *diaphragm, skg_body_organ *liver);

/* Finds the displacements of the liver's vertices with the tendon at weight 1. */
void skg_liver_course(const skg_body *body, const skg_body_organ *diaphragm, skg_body_organ *liver);

/* For what is carried by vertices of the liver: how much farther than these each vertex goes. */
void skg_liver_carries(const skg_body *body, skg_body_organ *carried);

/* The diaphragm from its rim to its tendon. */

/* Finds how far each vertex of the diaphragm is from the rim. */
skg_status skg_rim_find(const skg_body *body, skg_body_organ *diaphragm);

/* Sets its share of the dome's motion from that: 0 at the rim, growing along the muscle, 1 in the tendon. */
void skg_rim_share(const skg_body *body, skg_body_organ *diaphragm);

/* Distances over the surface of an organ. */

/* The distance of each vertex from the nearest given one, over the surface, in mm; smooth, as rounded edges and ridges
 * of the distance are: over a length of 12 mm (a choice).
 *
 * given     per vertex: 1 where the distance is 0
 * struts    pairs of vertices on both faces of a sheet, over which the way may lead
 * distance  result, per vertex; parts of the surface without a given vertex are far */
skg_status skg_surface_distance(const skg_body_organ *organ, const unsigned char *given, int64_t strut_count,
                                const int32_t *struts, double *distance);

/* Keeping facets from folding. Most that would are so thin that a little bend of the motion does it. */

/* Finds the thin facets of an organ that follows ribs and dome together, after its shares. */
skg_status skg_thin_find(skg_body_organ *organ);

/* Moves the corners of facets that would fold, by as little as keeps a tenth of their height: a continuous function of
 * the displacements. all: of every facet, instead of the thin ones. Returns whether there were any. */
int skg_thin_open(skg_body_organ *organ, int all);

#endif
