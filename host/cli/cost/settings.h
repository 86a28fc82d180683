/* Which settings are worth measuring, and in which order. */
#ifndef SKG_CLI_COST_SETTINGS_H
#define SKG_CLI_COST_SETTINGS_H

#include "cost/study.h"

/* The setting of the reference COST_OF_ALL but for its rays, which are the scene's: the best of every dial, as far as an image
 * of it takes at most `most_ms`. */
cost_setting cost_best_of_all(const cost_study *study, double most_ms);

/* Adds the points of all dials to the study, without measuring them, and the settings of their references. */
void cost_choose_settings(cost_study *study);

/* Adds a point, unless the study has it. */
void cost_add_point(cost_study *study, int dial, int reference, int priority, cost_setting setting);

#endif
