/* Slopes of path parameters when parts, vertices, source and detector move: the forward counterpart of forces.h. Private. */
#ifndef SKG_SLOPES_H
#define SKG_SLOPES_H

#include "gradient/forces.h"

/* Velocities. A twist is (translation, rotation) about the world's origin. */
typedef struct {
    double pose[6];         /* of the part */
    const double *vertices; /* [mesh->vertices][3] in the axes of the mesh; NULL: none */
    double source[3];       /* of the sample of the source that rays start from */
    double detector[6];     /* of the pixels */
    double beam[3];         /* of the direction camera->first of a parallel beam, across it */
} skg_velocities;

/* Whether a part moves against the rays: most directions move one part of many. */
int skg_slopes_move(const skg_velocities *velocities);

/* The properties of a part that its slopes have in common along all directions, with vertices in the device's numbering. */
typedef struct {
    double (*at)[3];    /* [vertices] in the world */
    double (*pixel)[2]; /* [vertices] column and row */
    double *inverse;    /* [vertices] 1 / t; with a parallel beam t */
    double (*pull)
        [3]; /* [faces] the normal over h, or over n . d; 0 for faces that are seen as lines or contain the source */
} skg_seen_faces;

/* Fills vertices `first` to end - 1. */
void skg_slopes_see_vertices(const skg_face_moments *faces, int64_t first, int64_t end, skg_seen_faces *seen);

/* Fills faces `first` to end - 1 when all vertices are. rounding: of the places of corners on the device, relative */
void skg_slopes_see_faces(const skg_face_moments *faces, double rounding, int64_t first, int64_t end,
                          skg_seen_faces *seen);

/* The slopes at the corners of faces `first` to end - 1, times `factor`; slopes: [end - first][3] n . (v - ray) / (h t_k) with the
 * velocity v of the corner and that of the ray there; with a parallel beam n . (v - ray) / (n . d). Those that are not finite are 0. */
void skg_slopes_find(const skg_face_moments *faces, const skg_velocities *velocities,
                     const skg_seen_faces *seen, double factor, int64_t first, int64_t end, double *slopes);

/* Adds the derivatives of the means of pixels by a face that is seen as a line, with the weights of `faces`.
 * values: [camera->rows][camera->columns] */
skg_status skg_slopes_spread(const skg_face_moments *faces, const skg_velocities *velocities, int64_t face,
                             double *values);

/* The derivative of |D| over |D|, where D goes from the source to a pixel. */
double skg_slope_of_ray(const skg_camera *camera, const skg_velocities *velocities, const double ray[3]);

/* The derivative of the logarithm of the distance of a point, which moves with `source`, from the detector's plane. way: from there to
 * a point of the plane. */
double skg_slope_of_distance(const skg_camera *camera, const skg_velocities *velocities, const double from[3],
                             const double way[3], const double source[3]);

#endif
