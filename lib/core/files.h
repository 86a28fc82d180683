/* Files that are read and written. Private. */
#ifndef SKG_FILES_H
#define SKG_FILES_H

#include "core/core.h"

#include <stdio.h>

/* --- The one way to open an input. *
 * Only regular files are read: a pipe or a terminal would let the caller wait, and a device such as /dev/zero never ends.
 * Opening waits for nobody. */

/* The longest files, in bytes: text that people write (scenes, tables, spectra, lists of poses), and everything else. */
#define SKG_INPUT_TEXT ((int64_t)256 << 20)
#define SKG_INPUT_LARGE ((int64_t)64 << 30)

/* Opens a file for reading.
 *
 * most     the longest file, in bytes
 * size     result: its length in bytes; NULL: not asked for
 * errors   SKG_ERR_FILE: it cannot be read, is not a regular file, or is longer */
skg_status skg_input_open(const char *path, int64_t most, FILE **stream, int64_t *size);

/* Checks a file that another library opens by its name as skg_input_open does. */
skg_status skg_input_check(const char *path, int64_t most);

/* Fails with the sentence for an input that is longer than `most` bytes. */
skg_status skg_input_fail_long(const char *path, int64_t most);

/* The bytes of a byte-order mark of UTF-8 at the start of a text, 3 or 0. Text in UTF-16 or UTF-32, as "Unicode text" of other
 * programs is, is refused: SKG_ERR_FORMAT. */
skg_status skg_text_mark(const char *path, const char *text, size_t length, size_t *mark);

/* The one way to open text that is read line by line: an input of at most SKG_INPUT_TEXT bytes, behind its mark. */
skg_status skg_text_open(const char *path, FILE **stream);

/* Reads an open input to its end, and a zero behind it; at most `most` bytes. The caller frees the text.
 *
 * path   for messages */
skg_status skg_input_read(FILE *stream, const char *path, int64_t most, char **text, size_t *length);

/* --- Files that appear whole or not at all: they are written under a temporary name in the same folder, synced and
 * renamed. */

typedef struct {
    FILE *stream; /* write here */
    char *path, *temporary;
} skg_output_file;

/* Opens the temporary file. A path that is a folder or a device is refused. */
skg_status skg_output_open(const char *path, skg_output_file *file);

/* Fails with SKG_ERR_OUTPUT; the sentence names the path, the reason and what to do about it.
 *
 * reason      a value of errno, or 0 if there is none
 * otherwise   the reason in words if `reason` is 0 */
skg_status skg_output_fail(const char *path, int reason, const char *otherwise);

/* Reports a failure of skg_part_open, as skg_output_fail does; the sentence names the leftover that is in the way. */
skg_status skg_output_part_fail(const char *path, const char *temporary, int reason);

/* Syncs, closes and renames the file. On failure no file is left. */
skg_status skg_output_commit(skg_output_file *file);

/* Closes and removes the temporary file. Does nothing after a commit or a failed open. */
void skg_output_discard(skg_output_file *file);

/* --- Numbers from text files: two columns, or one list. */

/* Reads the lines of `path`: each holds two numbers with blanks, a comma or a semicolon between them. Empty lines,
 * lines that start with # or %, and headings (lines before the first row that start with a letter) are skipped.
 *
 * word     NULL, or a word such as "histpoint": then only lines that hold it are read, and the numbers follow it
 * first    both arrays are allocated; the caller frees them
 * errors   SKG_ERR_FILE, or SKG_ERR_FORMAT with the line */
skg_status skg_read_columns(const char *path, const char *word, int64_t *count, double **first,
                            double **second);

/* Reads all numbers of `path`, with blanks, line ends, commas or semicolons between them; the rest of a line from # or % on is
 * skipped. The caller frees the numbers. Errors as above. */
skg_status skg_read_list(const char *path, int64_t *count, double **numbers);

/* Reads rows of `least` to `most` numbers (at most 8), all of the same number, without a word.
 *
 * width     numbers of a row
 * columns   [most] arrays of [count] that are allocated, NULL from `width` on; the caller frees them */
skg_status skg_read_columns_of(const char *path, int64_t least, int64_t most, int64_t *count, int64_t *width,
                               double **columns);

/* Reads a number with a decimal point, whatever the locale. *end points behind it, or to text if there is none. */
double skg_read_number(const char *text, const char **end);

#endif
