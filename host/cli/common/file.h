/* Files and folders that verbs write. Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_FILE_H
#define SKG_CLI_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A file that appears whole or not at all: it is written as NAME.part-PID-TAG in the same folder, synced and renamed. */
typedef struct {
    FILE *stream;           /* write by cli_file_write */
    char *path, *temporary; /* the name at the end, and until then */
    int reason;             /* errno of the first failure to write; 0: none */
} cli_file;

/* Opens the file under its temporary name. A path that is a folder or a device is refused. */
int cli_file_open(const char *path, cli_file *file);

/* Returns 1; 0 if it fails, which cli_file_commit reports. */
int cli_file_write(cli_file *file, const void *bytes, size_t count);

/* Syncs, closes and renames the file. On failure no file is left. */
int cli_file_commit(cli_file *file);

/* Closes and removes what is not finished. Does nothing after a commit or a failed open. */
void cli_file_discard(cli_file *file);

/* Refuses, before anything is computed, a file that could not be opened. */
int cli_file_check(const char *path);

/* Prints "path: cannot be written: reason". */
int cli_file_fail(const char *path, const char *reason);

/* Writes bytes to a file that appears whole or not at all. */
int cli_write_file(const char *path, const void *bytes, size_t count);

/* Whether a path ends in ".ext" after at least one more character, without regard to case. */
int cli_has_extension(const char *path, const char *extension);

/* Whether a path names a folder, as skg_scan_file_open takes it: it has no extension. */
int cli_names_folder(const char *path);

/* Makes a folder if it does not exist, but not those above it. A new name that ends like a film or a picture is
 * refused. */
int cli_make_folder(const char *folder);

enum { CLI_NAME_OF_PART = 160 };

/* A file name of a part's label, without extension. Blanks and slashes become hyphens. A label that is long, begins with a
 * dot or has control characters is shortened and mended, and gets the number of its part, so that names stay apart. */
void cli_name_of_part(const char *label, int64_t part, char name[CLI_NAME_OF_PART]);

/* "folder/name" from a printf format, which the caller frees; NULL if memory is exhausted. */
char *cli_path_in(const char *folder, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
