/* Displacements of points that follow other organs. Private. */
#ifndef SKG_FOLLOW_H
#define SKG_FOLLOW_H

#include "body/types.h"

/* The displacement of a link's end at the other organ. */
void skg_link_follow(const skg_body *body, const skg_link *link, double displacement[3]);

/* The displacement of a vertex of a carried organ or of the needle's tissue. */
void skg_carried_vertex(const skg_body *body, const skg_body_organ *organ, int64_t vertex,
                        double displacement[3]);

#endif
