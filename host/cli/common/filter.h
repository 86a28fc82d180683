/* The value of --filter. */
#ifndef SKG_CLI_FILTER_H
#define SKG_CLI_FILTER_H

#include <stddef.h>

/* The millimetres of "um", "mm", "cm" or "m"; 0 if the unit is none of these. */
double cli_millimetres(const char *unit);

/* Reads "Cu:0.1", "Al:2mm" or "Al 2 mm" into the material's name and its thickness. Returns an exit status and
 * prints the error. */
int cli_read_filter(const char *text, char *name, size_t size, double *mm);

#endif
