/* Where a ray crosses the surface of a part, traced in double on the host. Private.
 *
 * Coordinates are those of skg_camera_see: a point's h is (t i, t j, t), with a parallel beam (i, j, t - 1). A plane in the world
 * is a plane in these coordinates, too. */
#ifndef SKG_CROSSINGS_H
#define SKG_CROSSINGS_H

#include "geometry/optics.h"
#include "mesh/mesh.h"

/* The plane p[0] h[0] + p[1] h[1] + p[2] h[2] + p[3] = 0; the sum is positive behind it, seen from the source. */
typedef struct {
    double p[4];
} skg_seen_plane;

/* A ray enters or leaves a part. */
typedef struct {
    double depth; /* h[2] of the place */
    skg_seen_plane plane;
    int32_t owner;  /* the caller's number of the part */
    int32_t enters; /* 1: it enters, 0: it leaves */
} skg_crossing;

/* A list that grows; all zero: empty. */
typedef struct {
    skg_crossing *at;
    int64_t count, capacity;
} skg_crossing_list;

/* The triangles of a part, by the rows of pixels that they cover. */
typedef struct {
    const skg_camera *camera;
    const int32_t *corners; /* [triangles][3] */
    double *seen;           /* [vertices][3] h */
    int64_t *first;         /* [rows + 1] into triangles */
    int32_t *triangles;
    int32_t owner;
    int32_t mirrored; /* 1: triangles face inward, in the world */
} skg_crossings;

/* Prepares a part. All of it has to lie in front of a point source. pose: 4x4. Release it whatever this returns. */
skg_status skg_crossings_make(const skg_camera *camera, const skg_mesh *mesh, const double *pose,
                              int32_t owner, skg_crossings *crossings);
void skg_crossings_release(skg_crossings *crossings);

/* Appends the crossings of the ray to a place on the detector, in columns and rows, which lies in `row`. A ray through an edge is
 * taken to pass it on one side, so that it enters and leaves a closed part equally often. */
skg_status skg_crossings_find(const skg_crossings *crossings, const double place[2], int64_t row,
                              skg_crossing_list *list);

/* Sorts crossings by depth. */
void skg_crossings_sort(skg_crossing_list *list);

#endif
