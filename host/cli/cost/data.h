/* The study as JSON and as .csv. */
#ifndef SKG_CLI_COST_DATA_H
#define SKG_CLI_COST_DATA_H

#include "cost/study.h"

#include <jansson.h>

json_t *cost_json(const cost_study *study);

#endif
