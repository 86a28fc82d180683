/* A setting as a command line that a shell reads. */
#ifndef SKG_CLI_COST_COMMAND_H
#define SKG_CLI_COST_COMMAND_H

#include "cost/study.h"

/* The command line of `image` that a setting stands for, which the caller frees; NULL if memory is exhausted. */
char *cost_command(const cost_study *study, const cost_setting *setting);

#endif
