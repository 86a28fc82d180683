/* The scene with other numbers of triangles. */
#ifndef SKG_CLI_COST_MESHING_H
#define SKG_CLI_COST_MESHING_H

#include "cost/study.h"

/* Makes spheres and cylinders of 8 sectors or more, or the generated thorax, finer and coarser: for other
 * meshes it is not known which surface the triangles approximate. */
int cost_find_meshings(cost_study *study);

/* The scene of a setting, which belongs to the study; made when it is first needed. */
skg_status cost_scene_of(cost_study *study, const cost_setting *setting, skg_scene **scene);

#endif
