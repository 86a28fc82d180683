/* The scene with the generated thorax of other numbers of triangles. */
#ifndef SKG_CLI_COST_THORAX_H
#define SKG_CLI_COST_THORAX_H

#include "cost/study.h"

/* Whether the scene may be the generated thorax: a quick look. */
int cost_may_be_thorax(cost_study *study);

/* Whether every part of the generated thorax is in the scene, in its place. Generates a thorax, which takes seconds. */
int cost_is_thorax(cost_study *study);

/* Makes the scene of a meshing. */
skg_status cost_make_thorax(const cost_study *study, cost_meshing *meshing);

/* The time that making the scene of a meshing would take; 0: it is made. */
double cost_making_ms(const cost_study *study, const cost_meshing *meshing);

/* Adds meshings, coarser to finer, in which these parts are generated again. Their scenes are not made yet. */
void cost_list_thorax(cost_study *study);

#endif
