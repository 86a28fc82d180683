/* The chest wall: bones, and between them what moves as the bones around it do. Private. */
#ifndef SKG_WALL_H
#define SKG_WALL_H

#include "body/types.h"

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
