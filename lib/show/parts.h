/* The parts of a scene as triangles of the 3D view. Private. */
#ifndef SKG_SHOW_PARTS_H
#define SKG_SHOW_PARTS_H

#include "scene/scene.h"
#include "show/model.h"

/* Adds every part whose opacity is not 0.
 *
 * colours   [parts][4] red, green, blue, opacity
 * errors    SKG_ERR_SCENE if a vertex is not finite */
skg_status skg_show_parts_add(skg_show_model *model, const skg_scene *scene, const uint8_t *colours);

/* Widens a box (mm, in the world) by a part at its pose: by the corners of the part's own box. */
void skg_show_part_bounds(const skg_scene_part_data *part, double low[3], double high[3]);

#endif
