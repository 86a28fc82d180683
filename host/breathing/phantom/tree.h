/* The vessels of a lung: trunks from the hilum with two orders of branches. Private. */
#ifndef SKG_TREE_H
#define SKG_TREE_H

#include "phantom/rings.h"

/* Whether a ball lies in the lung. */
typedef int (*skg_tree_room)(const void *shape, const double centre[3], double radius);

/* Adds the vessels of one lung, each a closed tube; where they join, a gap is left. side: 1 left, -1 right. */
skg_status skg_shape_tree(const char *name, skg_tree_room room, const void *shape, double side,
                          double resolution, skg_mesh_arrays *arrays);

#endif
