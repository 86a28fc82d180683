/* Files and folders that verbs write. Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_FILE_H
#define SKG_CLI_FILE_H

#include <stddef.h>

/* Writes bytes to a file that appears whole or not at all. */
int cli_write_file(const char *path, const void *bytes, size_t count);

/* Whether a path ends in ".ext" after at least one more character, without regard to case. */
int cli_has_extension(const char *path, const char *extension);

/* Makes a folder if it does not exist, but not those above it. A new name that ends like a film or a picture is
 * refused. */
int cli_make_folder(const char *folder);

/* "folder/name" from a printf format, which the caller frees; NULL if memory is exhausted. */
char *cli_path_in(const char *folder, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
