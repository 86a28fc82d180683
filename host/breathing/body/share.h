/* How diaphragm, lungs, liver and the wall of the body follow ribs and dome together. Private.
 *
 * A vertex at p goes by s T + (1 - s) B(p). T is the displacement of the tendon, and B that of the bones around p. The
 * share s of the dome is 0 at the diaphragm's rim, which the ribs carry, grows along the muscle, whose fibres shorten
 * alike from end to end, and is 1 in the tendon. Lungs have the dome's share at their base and 0 at the upper wall,
 * the liver that of the dome above it, and less or more farther down, so that it keeps its volume. */
#ifndef SKG_SHARE_H
#define SKG_SHARE_H

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

#endif
