/* The program that turns the tables of this folder into one C file, whose types are in rows.h. A table with a mistake
 * stops the build; the message names file and line. */
#ifndef SKG_MATERIALS_TABLES_H
#define SKG_MATERIALS_TABLES_H

#include "rows.h"

#include <stdio.h>

/* The most rows of one element (XCOM has up to 100), and the longest line with its end. */
enum { KNOTS_MAX = 200, TEXT_MAX = 1024 };

typedef struct {
    const char *folder;
    const char *name; /* of the file being read */
    FILE *file;
    int line;
    char text[TEXT_MAX]; /* the line last read, without its end */
} table;

void table_open(table *t, const char *folder, const char *name);

/* Reads the next line that is neither a comment nor empty. At the end, closes the file and returns 0. */
int table_next(table *t);

/* Prints what is wrong with the present line and ends the program. */
void table_stop(const table *t, const char *why) __attribute__((noreturn));

/* Cuts the line at '|' into exactly `count` fields and removes the spaces around them. */
void table_fields(table *t, int count, char **fields);

/* Each writes its tables. The order of the calls is this one: elements name their knots, mixtures their elements. */
void write_cross_sections(const char *folder, FILE *out);
void write_elements(const char *folder, FILE *out);
void write_mixtures(const char *folder, FILE *out);
void write_all_shells(const char *folder, FILE *out);
void write_scattering(const char *folder, FILE *out);

/* The first knot of each element, filled by write_cross_sections. The last knot lies before the first one of the next
 * element. */
extern int first_knot[SKG_LAST_ELEMENT + 2];

#endif
