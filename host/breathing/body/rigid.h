/* Rotations and rigid fits. Private. */
#ifndef SKG_RIGID_H
#define SKG_RIGID_H

#include <stdint.h>

/* x -> centre + rotation (x - centre) + shift, mm; rotation row by row. */
typedef struct {
    double rotation[9], centre[3], shift[3];
} skg_rigid;

/* The rotation of a rotation vector, whose length is the angle in radians (Rodrigues). */
void skg_rotation(const double vector[3], double rotation[9]);

void skg_rigid_displace(const skg_rigid *rigid, const double point[3], double displacement[3]);

/* The rigid motion that takes points nearest to points + displacements, by least squares (Horn, J. Opt. Soc. Am. A 4
 * (1987) 629). Both are rows of x, y, z. */
void skg_rigid_fit(int64_t count, const double *points, const double *displacements, skg_rigid *rigid);

#endif
