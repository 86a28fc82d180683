/* Facts of the scene, its dials, and the settings of them that are worth measuring. */
#ifndef CLI_COST_DIALS_H
#define CLI_COST_DIALS_H

#include "cost/study.h"

/* Reads what the dials can be, and the scene's own setting. Close the study also after a failure. */
int cost_open(cost_study *study);
void cost_close(cost_study *study);

/* Which settings are worth measuring, and in which order. */

/* The setting of the reference COST_OF_ALL but for its rays, which are the scene's: the best of every dial, as far as an image
 * of it takes at most `max_ms`. */
cost_setting cost_best_of_all(const cost_study *study, double max_ms);

/* The repair that others are compared with. */
int32_t cost_best_repair(const cost_study *study);

/* Adds the points of all dials to the study, without measuring them, and the settings of their references. */
void cost_choose_settings(cost_study *study);

/* Changes a setting to a better value of a dial, for the coarse pass. Returns 0: there is none. */
int cost_improve(const cost_study *study, int dial, cost_setting *setting);

/* Adds a point of a dial, or of several, against its reference, unless the study has it. */
void cost_add_point(cost_study *study, int dial, int priority, cost_setting setting);

/* The scene with other numbers of triangles. */

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

/* The scene with other numbers of sectors of its spheres and cylinders. */

/* Adds meshings, coarser to finer, in which every sphere and cylinder of 8 sectors or more is made again. */
skg_status cost_find_round(cost_study *study);

/* The number of parts of which nothing but the triangles is known, and the label of the first of them: their meshes are
 * neither spheres, cylinders, cuboids nor step wedges. */
int64_t cost_count_unknown(const cost_study *study, const char **label);

/* The scene with the generated thorax of other numbers of triangles. */

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
