/* Folders that verbs write into. */
#ifndef SKG_CLI_FOLDER_H
#define SKG_CLI_FOLDER_H

#include "cli.h"

/* Makes a folder where it is missing (not those above it). CLI_OUTPUT with the sentence said. */
int cli_make_folder(const char *folder);

/* "folder/name" from a printf format; the caller frees it. NULL where memory is out. */
char *cli_path_in(const char *folder, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
