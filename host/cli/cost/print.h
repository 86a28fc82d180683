/* The study as a table on the terminal. */
#ifndef SKG_CLI_COST_PRINT_H
#define SKG_CLI_COST_PRINT_H

#include "cost/study.h"

void cost_print(const cost_study *study);

#endif
