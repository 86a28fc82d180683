/* Triangles of the 3D view that planes cut. Private. */
#ifndef SKG_SHOW_CLIP_H
#define SKG_SHOW_CLIP_H

#include "show/camera.h"
#include "show/model.h"

/* Of the triangles from `first` on, removes what lies beyond a plane: points p with dot(plane, p) > plane[3], mm in the world.
 * Triangles that cross it are cut; what is left of them stays in order, but for second triangles, which come last. */
skg_status skg_show_clip(skg_show_model *model, int64_t first, const double plane[4]);

/* Likewise what is nearer to the eye than camera->nearest, or behind it. */
skg_status skg_show_clip_near(skg_show_model *model, const skg_show_camera *camera, int64_t first);

#endif
