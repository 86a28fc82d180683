/* Ellipsoids that shape organs. Private. */
#ifndef SKG_ELLIPSOID_H
#define SKG_ELLIPSOID_H

typedef struct {
    double centre[3], axis[3]; /* axis: half axes, mm */
    double turned[3];          /* direction of the first axis; the second is horizontal */
} skg_ellipsoid;

/* <= 0 inside the ellipsoid whose half axes are larger by `larger` mm, outside about the distance in mm. */
double skg_ellipsoid_inside(const skg_ellipsoid *ellipsoid, const double point[3], double larger);

#endif
