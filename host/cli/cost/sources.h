/* How much each source of error contributes, what halving it costs, and how sure the numbers are. */
#ifndef SKG_CLI_COST_SOURCES_H
#define SKG_CLI_COST_SOURCES_H

#include "cost/study.h"

/* Fills in study->sources and ->largest from the measured points. */
int cost_find_sources(cost_study *study);

/* The scene's value of the source's dial, "43250 triangles"; empty: the source has no dial. */
void cost_describe_source(const cost_study *study, int number, char *text, size_t size);

/* Fills in study->unrest, ->reference_error and ->grey_levels. */
void cost_find_trust(cost_study *study);

#endif
