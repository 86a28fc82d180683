/* The table of all points as text. */
#ifndef SKG_CLI_COST_CSV_H
#define SKG_CLI_COST_CSV_H

#include "cost/study.h"

/* The caller frees the text; NULL if memory is exhausted. */
char *cost_csv(const cost_study *study);

#endif
