/* Rotations and rigid fits. Private. */
#ifndef SKG_RIGID_H
#define SKG_RIGID_H

#include <stdint.h>

/* x -> centre + rotation (x - centre) + shift, mm; rotation row by row. */
typedef struct {
    double rotation[9], centre[3], shift[3];
} skg_rigid;

/* exp of a rotation vector: its length is the angle in radians (Rodrigues). */
void skg_rotation(const double vector[3], double rotation[9]);

void skg_rigid_displace(const skg_rigid *rigid, const double point[3], double displacement[3]);

/* Eigenvectors of a symmetric n x n matrix (n <= 4), row k the k-th; values falling. The matrix is spoiled.
 */
void skg_eigen(int n, double *matrix, double *values, double *vectors);

/* The rigid motion that takes points nearest to points + displacements in the least squares (Horn, J. Opt.
 * Soc. Am. A 4 (1987) 629). Rows of x, y, z. */
void skg_rigid_fit(int64_t count, const double *points, const double *displacements, skg_rigid *rigid);

#endif
