/* Two columns of numbers from a text file. Private. */
#ifndef SKG_COLUMNS_H
#define SKG_COLUMNS_H

#include "core/core.h"

/* Reads the lines of `path`: each holds two numbers with blanks, a comma or a semicolon between them. Empty
 * lines, and those that start with #, % or a letter before the first row (a heading), are read past.
 * word: NULL, or a word such as "histpoint": then only lines that hold it count, and the numbers follow it.
 * The arrays are allocated; the caller frees them. SKG_ERR_FILE, SKG_ERR_FORMAT with the line. */
skg_status skg_read_columns(const char *path, const char *word, int64_t *count, double **first,
                            double **second);

/* A number as files write it: with a point, whatever the locale. *end: behind it, or text where none is. */
double skg_read_number(const char *text, const char **end);

#endif
