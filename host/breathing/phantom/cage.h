/* The cage, the surface on which the middle lines of the ribs lie, and the spine behind it. Private.
 *
 * Frame of the thorax: x to the patient's left, y to the back, z up, in mm; the origin is the top of the right half
 * of the diaphragm. Sizes are aggregates of the surfaces of BodyParts3D (one man, lying), to about 5 mm. Everything
 * inside the cage keeps clear of it by an inset, everything outside by an offset. */
#ifndef SKG_CAGE_H
#define SKG_CAGE_H

enum { SPINE_BODIES = 14 };

/* <= 0 inside the cage reduced by an inset, outside about the distance in mm. */
double skg_cage_inside(const double point[3], double inset);

/* Moves a point horizontally onto the cage. */
void skg_cage_project(double point[3]);

/* y of the cage's front, and of its back, at x and z. */
double skg_cage_front(double x, double z);
double skg_cage_back(double x, double z);

/* The bodies of vertebrae, T1 first: z of the middle and height. y of the middle of a body at z. */
extern const double skg_spine_body[SPINE_BODIES][2];
double skg_spine_depth(double z);

/* <= 0 where a point is clear of the spine, with rib heads and processes, by a gap. */
double skg_spine_inside(const double point[3], double gap);

#endif
