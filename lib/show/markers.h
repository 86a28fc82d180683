/* What the 3D view shows besides the parts: source, beam, detector, axes, path. Private. */
#ifndef SKG_SHOW_MARKERS_H
#define SKG_SHOW_MARKERS_H

#include "show/camera.h"
#include "show/model.h"

/* Adds everything but the parts. low, high: the box of the parts, mm. The two triangles of the detector come last, as
 * the kernel wants them. */
skg_status skg_show_markers_add(skg_show_model *model, const skg_view *view, const skg_look *look,
                                const skg_show_camera *camera, const double low[3], const double high[3]);

#endif
