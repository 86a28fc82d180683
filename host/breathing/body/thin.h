/* Keeping facets from folding. Most that would are so thin that a little bend of the motion does it. Private. */
#ifndef SKG_THIN_H
#define SKG_THIN_H

#include "body/types.h"

/* Finds the thin facets of an organ that follows ribs and dome together, after its shares. */
skg_status skg_thin_find(skg_body_organ *organ);

/* Moves the corners of facets that would fold, by as little as keeps a tenth of their height: a continuous function of
 * the displacements. all: of every facet, instead of the thin ones. Returns whether there were any. */
int skg_thin_open(skg_body_organ *organ, int all);

#endif
