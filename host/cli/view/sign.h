/* The name of this command in a PNG file that Cairo made. */
#ifndef SKG_CLI_SIGN_H
#define SKG_CLI_SIGN_H

#include <stddef.h>

/* Inserts a text chunk "Software: skiagraph VERSION" behind the header, by which cli_check_overwrite knows the file.
 * Returns an exit status and prints the error. */
int view_sign(char **bytes, size_t *count);

#endif
