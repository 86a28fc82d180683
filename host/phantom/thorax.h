/* The generated thorax: its common surfaces and the makers of its parts. Private.
 *
 * Frame: x to the patient's left, y to the back, z up, mm. The ribs' middle lines lie on one surface, the
 * cage; everything inside keeps clear of it by an inset, everything outside by an offset. */
#ifndef SKG_THORAX_H
#define SKG_THORAX_H

#include "phantom/shape.h"

#include <skiagraph/breathing.h>

enum { RIBS = 12, RIB_POINTS = 96, CARTILAGES = 10, SPINE_BODIES = 14, RIM_POINTS = 360 };

/* One rib of the left side; the right one is its mirror image. */
typedef struct {
    double line[RIB_POINTS][3]; /* middle line from the head, evenly in arc length */
    double height, width;       /* half axes of its section, mm */
} skg_rib;

/* What the makers share. */
typedef struct {
    double resolution;      /* 1: about 42,000 triangles */
    skg_rib rib[RIBS];      /* rib[k] is number k + 1 */
    double rim[RIM_POINTS]; /* radius of the diaphragm's rim about skg_dome_centre, by azimuth */
} skg_thorax_plan;

struct skg_thorax {
    int64_t parts, room;
    struct {
        char label[40];
        const char *material; /* a name of the tables, or NULL */
        double hounsfield, density;
        int64_t inside;
        skg_mesh *mesh;
    } * part;
};

/* cage.c */
double skg_cage_inside(const double point[3], double inset); /* <= 0 inside the cage, about mm */
void skg_cage_project(double point[3]);                      /* horizontally onto the cage */
double skg_cage_front(double x, double z);                   /* y of its front there */
skg_status skg_cage_plan(double resolution, skg_thorax_plan *plan);
double skg_rib_distance(const skg_thorax_plan *plan, const double point[3]); /* to the nearest middle line */
extern const double skg_spine_body[SPINE_BODIES][2];        /* z of the middle, height; T1 first; mm */
double skg_spine_depth(double z);                           /* y of the middle of the bodies */
double skg_spine_inside(const double point[3], double gap); /* <= 0 clear of the spine by gap */

/* dome.c */
extern const double skg_dome_centre[2];
void skg_dome_rim(skg_thorax_plan *plan);
double skg_dome_rim_radius(const skg_thorax_plan *plan, double azimuth);
double skg_dome_rim_distance(const skg_thorax_plan *plan, double x, double y); /* about mm; > 0 within */
double skg_dome_rim_height(double azimuth);
double skg_dome_height(const skg_thorax_plan *plan, double x, double y);    /* of the diaphragm's middle */
double skg_dome_steepness(const skg_thorax_plan *plan, double x, double y); /* 1/cos of its slope */

/* An ellipsoid about centre; axis: half axes; turned: its x axis. <= 0 inside, about mm. */
typedef struct {
    double centre[3], axis[3], turned[3];
} skg_ellipsoid;
double skg_ellipsoid_inside(const skg_ellipsoid *ellipsoid, const double point[3], double larger);

/* Makers: each adds parts to the thorax. */
skg_status skg_thorax_add(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays);
typedef skg_status (*skg_thorax_maker)(const char *label, void *shape, skg_mesh_arrays *arrays);
skg_status skg_thorax_fit(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_thorax_maker maker, void *shape, double *gap); /* gap: of the shape, mm */
skg_status skg_thorax_bones(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_lungs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_organs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_skin(const skg_thorax_plan *plan, skg_thorax *thorax);
skg_status skg_thorax_needle(const skg_thorax_plan *plan, skg_thorax *thorax);

/* Shared by lungs and organs: heart and airways. */
extern const skg_ellipsoid skg_heart;
double skg_airway_distance(const double point[3]); /* to the airways' walls, mm; < 0 within */
skg_status skg_thorax_airways(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);

#endif
