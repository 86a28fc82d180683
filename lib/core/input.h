/* The one way to open an input. Private.
 *
 * Only regular files are read: a pipe or a terminal would let the caller wait, and a device such as /dev/zero never ends.
 * Opening waits for nobody. */
#ifndef SKG_INPUT_H
#define SKG_INPUT_H

#include "core/core.h"

#include <stdio.h>

/* The longest files, in bytes: text that people write (scenes, tables, spectra, lists of poses), and everything else. */
#define SKG_INPUT_TEXT ((int64_t)256 << 20)
#define SKG_INPUT_LARGE ((int64_t)64 << 30)

/* Opens a file for reading.
 *
 * most     the longest file, in bytes
 * size     result: its length in bytes; NULL: not asked for
 * errors   SKG_ERR_FILE: it cannot be read, is not a regular file, or is longer */
skg_status skg_input_open(const char *path, int64_t most, FILE **stream, int64_t *size);

/* The same check for a file that another library opens by its name. */
skg_status skg_input_check(const char *path, int64_t most);

/* Fails with the sentence for an input that is longer than `most` bytes. */
skg_status skg_input_fail_long(const char *path, int64_t most);

/* Reads an open input to its end, and a zero behind it; at most `most` bytes. The caller frees the text.
 *
 * path   for messages */
skg_status skg_input_read(FILE *stream, const char *path, int64_t most, char **text, size_t *length);

#endif
