/* The measures of the generated thorax that the makers of its parts share. Private. */
#ifndef SKG_PHANTOM_ANATOMY_H
#define SKG_PHANTOM_ANATOMY_H

#include "core/core.h"

/* The cage, the surface on which the middle lines of the ribs lie, and the spine behind it.
 *
 * Frame of the thorax: x to the patient's left, y to the back, z up, in mm; the origin is the top of the right half
 * of the diaphragm. Sizes are aggregates of the surfaces of BodyParts3D (one man, lying), to about 5 mm. Everything
 * inside the cage keeps clear of it by an inset, everything outside by an offset. */

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

/* The diaphragm's middle surface: two domes over a rim that fits the cage and leaves out the spine. */

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

/* The ribs' middle lines. */

enum { RIBS = 12, RIB_POINTS = 96 };

/* One rib of the left side; the right one is its mirror image. */
typedef struct {
    double line[RIB_POINTS][3]; /* middle line from the head, evenly in arc length */
    double height, width;       /* half axes of its section, mm */
} skg_rib;

/* Fills rib number k + 1: from the head beside the spine backward to the angle, which is on the cage, and from there
 * along the cage. Where not simple, the neck runs to the side as much as backward. */
skg_status skg_rib_fill(int k, int simple, skg_rib *rib);

/* Distance in mm to the nearest point of a middle line, on the point's own side. */
double skg_rib_distance(const skg_rib ribs[RIBS], const double point[3]);

/* The great vessels and the oesophagus. */

enum { VESSELS = 8, VESSEL_POINTS = 33 };

/* A vessel's middle line, evenly in arc length, the radii of its ends, and bounds of the whole, mm. */
typedef struct {
    const char *label;
    double hounsfield, rings; /* rings at resolution 1 */
    double line[VESSEL_POINTS][3], radius[2], low[3], high[3];
} skg_vessel;

skg_status skg_vessels_fill(skg_vessel vessels[VESSELS]);

/* Distance in mm to the vessels' walls; < 0 inside. At most 30. */
double skg_vessel_distance(const skg_vessel vessels[VESSELS], const double point[3]);

/* Distance in mm to the walls of trachea and main bronchi; < 0 inside. simple: as in the plan. */
double skg_airway_distance(int simple, const double point[3]);

/* Common data from which all parts are made. */
typedef struct {
    int simple;                 /* 1: the simple thorax */
    double resolution;          /* lengths of edges go with 1/resolution */
    double gap;                 /* mm that organs keep to each other */
    skg_rib rib[RIBS];          /* rib[k] is number k + 1 */
    skg_dome diaphragm;         /* its middle surface */
    skg_vessel vessel[VESSELS]; /* of the thorax that is not simple */
} skg_thorax_plan;

skg_status skg_thorax_plan_fill(int simple, double resolution, skg_thorax_plan *plan);

/* <= 0 inside the heart enlarged by `larger` mm, outside about the distance in mm. */
double skg_heart_inside(const skg_thorax_plan *plan, const double point[3], double larger);

#endif
