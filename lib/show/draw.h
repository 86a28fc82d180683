/* Draws the triangles of the 3D view on the device. Private. */
#ifndef SKG_SHOW_DRAW_H
#define SKG_SHOW_DRAW_H

#include "show/camera.h"
#include "show/model.h"

/* Draws and waits. image: [image_rows][image_columns] grey values of the detector. rgba: as skg_scene_picture. */
skg_status skg_show_draw(skg_context *context, const skg_show_model *model, const skg_show_camera *camera,
                         const skg_look *look, int64_t image_columns, int64_t image_rows,
                         const uint8_t *image, uint8_t *rgba);

#endif
