/* Files of the user that lie beside an input are not overwritten. */
#ifndef SKG_CLI_OVERWRITE_H
#define SKG_CLI_OVERWRITE_H

#include "common/args.h"

/* Refuses an output that is an input, and one that exists in the folder of an input, or below it, and that this command
 * did not write: its files name it. Inputs are the operands and the files of flags. Returns an exit status and prints
 * the error. */
int cli_check_overwrite(const cli_arguments *arguments, const char *path);

/* Checks the files of every -o. */
int cli_check_overwrites(const cli_arguments *arguments);

#endif
