/* The parts of a scene as triangles of the 3D view. Private. */
#ifndef SKG_SHOW_PARTS_H
#define SKG_SHOW_PARTS_H

#include "scene/scene.h"
#include "show/camera.h"
#include "show/model.h"

/* Adds every part whose opacity in look->colours is not 0, as far as the look's cut and the eye leave it.
 *
 * errors    SKG_ERR_SCENE if a vertex is not finite */
skg_status skg_show_parts_add(skg_show_model *model, const skg_scene *scene, const skg_look *look,
                              const skg_show_camera *camera);

/* The pose of a part: the look's, or the scene's. */
const double *skg_show_pose_of(const skg_scene *scene, const skg_look *look, int64_t part);

/* Widens a box (mm, in the world) by a mesh at a pose: by the corners of the mesh's own box. */
void skg_show_part_bounds(const skg_mesh *mesh, const double *pose, double low[3], double high[3]);

#endif
