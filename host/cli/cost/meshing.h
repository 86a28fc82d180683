/* The scene with other numbers of triangles. */
#ifndef SKG_CLI_COST_MESHING_H
#define SKG_CLI_COST_MESHING_H

#include "cost/study.h"

/* Makes spheres and cylinders of 8 sectors or more, or the generated thorax, finer and coarser: for other
 * meshes it is not known which surface the triangles approximate. */
int cost_find_meshings(cost_study *study);

#endif
