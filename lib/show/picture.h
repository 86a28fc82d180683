/* Pictures of a scene. Private. */
#ifndef SKG_SHOW_PICTURE_H
#define SKG_SHOW_PICTURE_H

#include <skiagraph/view_picture.h>

/* As skg_view_picture, but tests nothing. */
skg_status skg_show_picture(skg_context *context, const skg_scene *scene, const skg_view *view,
                            const skg_look *look, uint8_t *rgba);

#endif
