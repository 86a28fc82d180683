/* Ribs: a plane each, an axis through the head, one angle. Private. */
#ifndef SKG_BODY_RIBS_H
#define SKG_BODY_RIBS_H

#include "body/types.h"

/* Finds head and axis of a rib, but for what the caller gave. */
skg_status skg_rib_prepare(const skg_body *body, skg_body_organ *rib);

/* The angle in rad by which the plane of rib 5 turns at full inspiration, as measured; and by what a body's options multiply
 * a rib's rotation. */
double skg_rib_angle(void);
double skg_rib_factor(const skg_body_options *options, const skg_body_organ *rib);

/* Fraction of the rotation at full inspiration that a thoracic weight is. */
double skg_rib_fraction(double weight);

/* Pump and bucket angle of the rib's plane, rad. displacements: of the vertices; NULL: at rest. */
void skg_rib_plane(const skg_body_organ *rib, const double *displacements, double *pump, double *bucket);

#endif
