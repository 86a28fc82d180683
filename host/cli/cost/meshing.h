/* The scene with other numbers of triangles. */
#ifndef SKG_CLI_COST_MESHING_H
#define SKG_CLI_COST_MESHING_H

#include "cost/study.h"

/* Lists spheres and cylinders of 8 sectors or more, or the generated thorax, finer and coarser: for other
 * meshes it is not known which surface the triangles approximate. */
int cost_find_meshings(cost_study *study);

/* Leaves out the finest meshings if the time does not suffice to make them, and all if none is finer than the scene. */
void cost_limit_meshings(cost_study *study);

/* The meshing that shows how much the number of triangles changes the image: the next finer one if it is made, otherwise the next
 * coarser one, which takes less time to make; -1: none. */
int cost_coarse_meshing(const cost_study *study);

/* The scene of a setting, which belongs to the study; made when it is first needed. */
skg_status cost_scene_of(cost_study *study, const cost_setting *setting, skg_scene **scene);

#endif
