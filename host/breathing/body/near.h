/* Finding organs, and the nearest points on them. Private. */
#ifndef SKG_NEAR_H
#define SKG_NEAR_H

#include "body/types.h"

/* The distance in mm from a point to the nearest point of an organ's triangles, and that point as corners and weights
 * of the link; HUGE_VAL where it is farther than `reach`. */
double skg_nearest(const skg_body_organ *organ, const double point[3], double reach, skg_link *link);

/* The first organ whose label begins with a word; -1: none. */
int32_t skg_find_organ(const skg_body *body, const char *word);

#endif
