/* Checks the pose of a part. */
#include "scene/pose.h"

#include "core/maths.h"

#include <float.h>
#include <math.h>

/* The determinant is compared with the product of the lengths of the columns, so that a small or large scale is no
 * reason to refuse a pose. */
skg_status skg_scene_check_pose(const char *label, const double *pose) {
    if (!skg_all_finite(pose, 16))
        return skg_fail(SKG_ERR_SCENE, "part %s: its pose has an entry that is not finite", label);
    if (fabs(pose[12]) + fabs(pose[13]) + fabs(pose[14]) + fabs(pose[15] - 1) > 0)
        return skg_fail(SKG_ERR_SCENE,
                        "part %s: the last row of its pose is (%g, %g, %g, %g); an affine pose has (0, 0, 0, "
                        "1) there, row by row",
                        label, pose[12], pose[13], pose[14], pose[15]);
    double volume = 1;
    for (int c = 0; c < 3; c++) volume *= skg_length((const double[3]){pose[c], pose[4 + c], pose[8 + c]});
    /* 16 epsilon cover the rounding of a determinant, which is a sum of six products of three. */
    if (!(fabs(skg_pose_determinant(pose)) > 16 * DBL_EPSILON * volume) || !isfinite(volume))
        return skg_fail(SKG_ERR_SCENE,
                        "part %s: its pose is singular (it flattens the part); give one that can be undone",
                        label);
    return SKG_OK;
}
