/* The scene with other numbers of sectors of its spheres and cylinders. */
#ifndef SKG_CLI_COST_ROUND_H
#define SKG_CLI_COST_ROUND_H

#include "cost/study.h"

/* Adds meshings, coarser to finer, in which every sphere and cylinder of 8 sectors or more is made again. */
skg_status cost_find_round(cost_study *study);

/* The number of parts of which nothing but the triangles is known, and the label of the first of them: their meshes are
 * neither spheres, cylinders, cuboids nor step wedges. */
int64_t cost_count_unknown(const cost_study *study, const char **label);

#endif
