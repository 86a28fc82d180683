/* The diaphragm's middle surface: two domes over a rim that fits the cage and leaves out the spine. Private. */
#ifndef SKG_DOME_H
#define SKG_DOME_H

enum { RIM_POINTS = 360 };

typedef struct {
    double rim[RIM_POINTS]; /* radius of the rim about skg_dome_centre, by azimuth, mm */
} skg_dome;

extern const double skg_dome_centre[2];      /* x, y */
extern const double skg_dome_half_thickness; /* of the diaphragm, mm */

void skg_dome_fill(skg_dome *dome);

/* The rim's radius, the distance of a point inside it to it (about mm; < 0 outside), and its height: the xiphoid in
 * front, the costal margin at the sides, deepest behind. */
double skg_dome_rim_radius(const skg_dome *dome, double azimuth);
double skg_dome_rim_distance(const skg_dome *dome, double x, double y);
double skg_dome_rim_height(double azimuth);

/* z of the middle surface, and 1/cos of its slope. */
double skg_dome_height(const skg_dome *dome, double x, double y);
double skg_dome_steepness(const skg_dome *dome, double x, double y);

#endif
