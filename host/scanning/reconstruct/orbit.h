/* How the views of a scan go about its axis, and how much each ray counts. Private. */
#ifndef SKG_ORBIT_H
#define SKG_ORBIT_H

#include "core/core.h"

#include <skiagraph/reconstruct.h>

/* A projection as the reconstruction sees it. */
typedef struct {
    skg_view view;
    int64_t index;
    int is_parallel;
    double forward[3]; /* length 1, across the axis: from the source to the axis, or along the beam */
    double across[3];  /* length 1, across axis and forward: where the source goes */
    double radius;     /* distance of the source from the axis, mm; 0 for a parallel beam */
    double depth[3];   /* of a point source, length 1: away from it, across the axis and the rows */
    double spacing;    /* of the columns across the axis, mm; of a curved detector as seen at the axis */
    double centre[3];  /* on the axis */
    double angle;      /* from that of the first projection, rad, not below 0 */
    double fan_step;   /* of a curved detector, rad from one column to the next; 0: it is flat */
} skg_orbit_pose;

typedef struct {
    double axis[3];     /* of length 1; the source goes counter-clockwise about it */
    double step, range; /* rad: of one projection, from the first to the last */
    double fan;         /* rad: widest angle of a ray with forward */
    double low, high;   /* places of the outermost columns across the beam (skg_orbit_place) */
    int is_full;
    int is_parker; /* a short scan of a point source: Parker's weights */
    /* rad: after so much the same lines are seen again; half a turn of a parallel beam that is not displaced */
    double period;
    double times;  /* whole periods */
    double excess; /* rad: what the scan goes on beyond them */
    int displaced; /* in a full turn: 1 or -1, the side on which the detector is wider by more than a column; else 0 */
} skg_orbit;

skg_status skg_orbit_find(skg_scan *scan, const skg_fdk_options *options, skg_orbit *orbit);
skg_status skg_orbit_pose_get(skg_scan *scan, const skg_fdk_options *options, const skg_orbit *orbit,
                              int64_t index, skg_orbit_pose *pose);

/* The ray from the source to a pixel. */
void skg_orbit_ray(const skg_orbit_pose *pose, int64_t row, int64_t column, double *ray);

/* Where a ray of a column is across the beam: its fan angle, rad, or, in a parallel beam, its distance from the axis, mm. The ray
 * along the same line from the other side has the place with the other sign. */
double skg_orbit_place(const skg_orbit_pose *pose, int64_t row, int64_t column);

/* The radius about the axis, mm, that rays up to such a place touch. */
double skg_orbit_radius(const skg_orbit_pose *pose, double place);

/* The share of a ray in the sum over all that run along its line: 1/2 in a full turn, 1 in half a turn of a parallel beam; less at the
 * ends of a scan that sees some directions once more; of a displaced detector from 0 to 1, which add up to 1 for the two rays of a
 * line (G. Wang, Med. Phys. 29 (2002) 1634-1636); Parker's weight in a short scan of a point source. */
double skg_orbit_weight(const skg_orbit *orbit, const skg_orbit_pose *pose, const double *ray, double place);

#endif
