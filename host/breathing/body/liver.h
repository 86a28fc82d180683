/* The liver under the dome. Private. */
#ifndef SKG_LIVER_H
#define SKG_LIVER_H

#include "body/types.h"

/* Finds which vertices lie under the dome. */
skg_status skg_liver_find(const skg_body_organ *diaphragm, skg_body_organ *liver);

/* Finds the displacements of the liver's vertices with the tendon at weight 1. */
void skg_liver_course(const skg_body *body, const skg_body_organ *diaphragm, skg_body_organ *liver);

/* For what is carried by vertices of the liver: how much farther than these each vertex goes. */
void skg_liver_carries(const skg_body *body, skg_body_organ *carried);

#endif
