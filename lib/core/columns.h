/* Numbers from text files: two columns, or one list. Private. */
#ifndef SKG_COLUMNS_H
#define SKG_COLUMNS_H

#include "core/core.h"

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

/* The same for rows of `least` to `most` numbers (at most 8), all of the same number, without a word.
 *
 * width     numbers of a row
 * columns   [most] arrays of [count] that are allocated, NULL from `width` on; the caller frees them */
skg_status skg_read_columns_of(const char *path, int64_t least, int64_t most, int64_t *count, int64_t *width,
                               double **columns);

/* Reads a number with a decimal point, whatever the locale. *end points behind it, or to text if there is none. */
double skg_read_number(const char *text, const char **end);

#endif
