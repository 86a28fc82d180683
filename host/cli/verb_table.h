/* Table of the verbs and the functions that run them. */
#ifndef SKG_CLI_VERB_TABLE_H
#define SKG_CLI_VERB_TABLE_H

#include "common/args.h"

typedef struct {
    const cli_manual *manual;
    int (*run)(const cli_arguments *arguments); /* returns an exit status */
} cli_verb;

extern const cli_verb cli_verbs[]; /* ends with a NULL manual */

#endif
