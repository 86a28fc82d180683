/* The value of --unit. */
#ifndef SKG_CLI_UNIT_H
#define SKG_CLI_UNIT_H

#include "common/args.h"

/* The millimetres of the unit that --unit names for the numbers in mesh files; 1 if it was not given. Returns an exit
 * status and prints the error. */
int cli_mesh_unit(const cli_arguments *arguments, double *unit_mm);

#endif
