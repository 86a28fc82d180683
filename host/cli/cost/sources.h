/* How much each source of error contributes, what halving it costs, and how sure the numbers are. */
#ifndef SKG_CLI_COST_SOURCES_H
#define SKG_CLI_COST_SOURCES_H

#include "cost/study.h"

/* Fills in study->sources and ->largest from the measured points. */
int cost_find_sources(cost_study *study);

/* The scene's value of the source's dial, "43250 triangles"; empty: the source has no dial. */
void cost_describe_source(const cost_study *study, int number, char *text, size_t size);

/* The dial of a source that has one. */
int cost_source_dial(int source);

/* Why the scene has no such error; NULL: it may have it. */
const char *cost_why_absent(const cost_study *study, int source);

/* Why a source that the scene may have is not measured. */
const char *cost_why_not(const cost_study *study, int source);

/* Fills in study->unrest and ->priced, and the uncertainty of what was timed in one visit. */
void cost_find_unrest(cost_study *study);

/* Fills in study->reference_error and ->grey_levels, after the sources. */
void cost_find_trust(cost_study *study);

#endif
