/* The command line: flags by table, values by kind. Functions that return int return an exit status:
 * CLI_DONE, or CLI_USAGE after printing the error. */
#ifndef SKG_CLI_ARGS_H
#define SKG_CLI_ARGS_H

#include "manual/manual.h"

#include <stdint.h>

/* A parsed command line; texts are the program's arguments themselves. */
typedef struct {
    const cli_manual *manual;
    const char **operands;
    int operand_count;
    int help; /* 1: --help was given */
    struct cli_given {
        const cli_flag *flag;
        const char *value;
    } * given;
    int given_count;
} cli_arguments;

/* Reads what follows the verb. The caller frees the arguments, also after a failure. */
int cli_parse(const cli_manual *manual, int count, char **words, cli_arguments *arguments);
void cli_arguments_free(cli_arguments *arguments);

int cli_given(const cli_arguments *arguments, const cli_flag *flag);

/* The value given last, or NULL. */
const char *cli_value(const cli_arguments *arguments, const cli_flag *flag);

/* The value of the flag's occurrence `index`, counted from 0, or NULL. */
const char *cli_nth_value(const cli_arguments *arguments, const cli_flag *flag, int index);

/* These four leave their results as they are if the flag was not given. cli_choice: the index in
 * flag->values. */
int cli_choice(const cli_arguments *arguments, const cli_flag *flag, int32_t *choice);
int cli_integer(const cli_arguments *arguments, const cli_flag *flag, int64_t least, int64_t most,
                int64_t *number);
int cli_number(const cli_arguments *arguments, const cli_flag *flag, double least, double most,
               double *number);
int cli_range(const cli_arguments *arguments, const cli_flag *flag, double *low, double *high);

/* Reads a phase of the breath, from 0 to below 1. given: what the user wrote, for the message. */
int cli_phase(const char *given, const char *value, double *phase);

/* Reports an unknown name with the nearest known one. what: "verb", "flag"; help: the words after `skiagraph`
 * that list all. */
int cli_unknown(const char *what, const char *name, const char *const *known, int count, const char *help);

#endif
