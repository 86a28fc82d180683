/* Bones: their axes, the rotation of the ribs, and the chest wall between them. Private. */
#ifndef SKG_BODY_BONES_H
#define SKG_BODY_BONES_H

#include "body/types.h"

/* Axes from the shapes of bones. */

/* Head of a rib, and direction (length 1) from there to its tubercle, by the vertebrae of the body; 0: its vertebra
 * is not in the body. */
int skg_rib_bone_axis(const skg_body *body, const skg_body_organ *rib, double head[3], double along[3]);

/* Principal axes of the surface's inertia (rows of length 1, the axis of most spread first), and the posterior end of
 * the first; of a rib, the end nearer to the spine. */
void skg_inertia_axes(const skg_body_organ *organ, double axes[9], double end[3]);

/* Ribs: a plane each, an axis through the head, one angle. */

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

/* The chest wall: bones, and between them what moves as the bones around it do. */

/* Finds by which bones a point of the wall moves, and their weights, which add up to 1, or to 0 where no bone is
 * near. Weights are continuous functions of the point. spine: 1 if the bones that stay count too. Returns the
 * distance to the nearest bone in mm; HUGE_VAL: none is near. */
double skg_wall_bones(const skg_body *body, int spine, const double p[3], int32_t bone[BONES],
                      double weight[BONES]);

/* Takes over the motions of the bones as they are posed. */
void skg_wall_prepare(skg_body *body);

/* The displacements of an organ's vertices by their bones as posed: into moved. */
void skg_wall_displace(const skg_body *body, skg_body_organ *organ);

#endif
