/* Findings from the measured points: sources of error, a summary, advice. */
#ifndef CLI_COST_FINDINGS_H
#define CLI_COST_FINDINGS_H

#include "cost/study.h"

/* --- Sources of error: their size, the price of halving them, and the uncertainty of the numbers. */

/* Fills in study->judged.sources and .largest from the measured points. */
int cost_find_sources(cost_study *study);

/* The scene's value of the source's dial, "43250 triangles"; empty: the source has no dial. */
void cost_describe_source(const cost_study *study, int number, char *text, size_t size);

/* Fills the source of error that scatter is, from its prediction or its histories. */
void cost_take_scatter(const cost_study *study, cost_source *source);

/* A source of error: its name, and its dial; COST_SCENE: it has none. */
typedef struct {
    const char *name;
    int dial;
} cost_source_row;
extern const cost_source_row cost_sources[COST_SOURCES];

/* Why the scene has no such error; NULL: it may have it. */
const char *cost_why_absent(const cost_study *study, int source);

/* Why a source that the scene may have is not measured. */
const char *cost_why_not(const cost_study *study, int source);

/* Fills in study->judged.unrest, and the uncertainty of what was timed in fewer than three runs: the unrest's share of its price, and all of
 * it where that is not known either. */
void cost_find_unrest(cost_study *study);

/* Fills in study->judged.reference_error and .grey_levels, after the sources. */
void cost_find_trust(cost_study *study);

/* The scene's costs in one sentence, and what is worth changing. */

/* Fills in study->judged.buy, .saving and .summary. */
void cost_summarise(cost_study *study);

/* A number in words, by value: cost_percent(share).of lasts for the expression. */
typedef struct {
    char of[64];
} cost_text;

/* "0.21 %", for a fraction. */
cost_text cost_percent(double share);

/* "8.1 ms", with "+-" and the uncertainty where it matters. */
cost_text cost_ms(double ms, double uncertainty_ms);

/* Words for a difference of times: "+3.1 ms", "+3.1 +- 0.2 ms", "-2 ms", "the same time within +- 0.5 ms". */
cost_text cost_more(double ms, double uncertainty_ms);

/* Which setting to use: marks the frontier and fills study->judged.advice; measures the combinations that were not measured
 * yet. */
int cost_advise(cost_study *study);

#endif
