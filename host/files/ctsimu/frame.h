/* Coordinate systems of source, detector, stage and samples in each projection. Private. */
#ifndef SKG_CTSIMU_FRAME_H
#define SKG_CTSIMU_FRAME_H

#include "ctsimu/item.h"

/* A coordinate system: origin, mm, and three axes of length 1 in the columns of `axes`, row by row. */
typedef struct {
    double centre[3];
    double axes[9];
} skg_system;

/* Which axes a vector's components belong to. */
typedef enum { SKG_AXES_WORLD, SKG_AXES_LOCAL, SKG_AXES_SAMPLE } skg_vector_axes;

typedef struct {
    skg_vector_axes axes;
    skg_parameter components[3];
} skg_scene_vector;

typedef struct {
    int32_t is_rotation, is_known;
    skg_scene_vector axis, pivot;
    skg_parameter amount;
} skg_deviation;

/* An object of the scene: where it is, its orientation, and how it deviates. */
typedef struct {
    int32_t is_on_stage; /* 1: in the axes of the stage */
    skg_scene_vector centre, u, w;
    int64_t deviation_count;
    skg_deviation *deviations;
} skg_placement;

/* Reads geometry.source and its like, or the position of a sample. Free also after a failure. */
skg_status skg_placement_read(const skg_item *item, skg_placement *placement);
void skg_placement_free(skg_placement *placement);

/* The system of an object in a projection.
 *
 * turn    rotation about its own w, rad: of the stage
 * stage   of an object on the stage, otherwise NULL
 * known   1: without the deviations and drifts that the reconstruction does not know
 * system  in the axes of the world, or of the stage for an object on it */
void skg_placement_at(const skg_placement *placement, int64_t frame, double turn, const skg_system *stage,
                      int known, skg_system *system);

/* A point or direction of the world in the axes of a system. */
void skg_system_point(const skg_system *system, const double *point, double *local);
void skg_system_direction(const skg_system *system, const double *direction, double *local);

#endif
