/* The command line: flags by table, values by kind. Functions that return int return an exit status:
 * CLI_DONE, or CLI_USAGE with the sentence said. */
#ifndef SKG_CLI_ARGS_H
#define SKG_CLI_ARGS_H

#include "cli.h"

/* Reads what follows the verb. The caller frees the arguments, also after a failure. */
int cli_parse(const cli_verb *verb, int count, char **words, cli_arguments *arguments);
void cli_arguments_free(cli_arguments *arguments);

int cli_given(const cli_arguments *arguments, const cli_flag *flag);

/* The value given last, or NULL. */
const char *cli_value(const cli_arguments *arguments, const cli_flag *flag);

/* The value given as number `index` from 0, or NULL. */
const char *cli_nth_value(const cli_arguments *arguments, const cli_flag *flag, int index);

/* Each leaves *place as it is when the flag was not given. */
int cli_choice(const cli_arguments *arguments, const cli_flag *flag, const char *const *names, int count,
               int32_t *place);
int cli_integer(const cli_arguments *arguments, const cli_flag *flag, int64_t least, int64_t most,
                int64_t *place);
int cli_number(const cli_arguments *arguments, const cli_flag *flag, double least, double most,
               double *place);
int cli_range(const cli_arguments *arguments, const cli_flag *flag, double *low, double *high);

/* Says that `name` is not known, with the nearest that is. what: "verb", "flag". */
int cli_unknown(const char *what, const char *name, const char *const *known, int count, const char *help);

/* Opens the device of --device. The caller releases the context. */
int cli_open_context(const cli_arguments *arguments, skg_context **context, skg_device_info *device);

void cli_print_help(const cli_verb *verb);

#endif
