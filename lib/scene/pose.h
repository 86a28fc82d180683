/* Poses of parts and volumes. Private. */
#ifndef SKG_SCENE_POSE_H
#define SKG_SCENE_POSE_H

#include "core/core.h"

/* SKG_ERR_SCENE, with the label, if a pose (4x4, row by row) is not finite, not affine or singular. */
skg_status skg_scene_check_pose(const char *label, const double *pose);

#endif
