/* The program that turns the tables of this folder into one C file (lib/material/tables.h). A table that is
 * not as it should be stops the build with file and line. */
#ifndef SKG_MATERIALS_TABLES_H
#define SKG_MATERIALS_TABLES_H

#include "rows.h"

#include <stdio.h>

enum { MOST_KNOTS = 200, MOST_TEXT = 1024 };

typedef struct {
    const char *folder;
    const char *name; /* of the file being read */
    FILE *file;
    int line;
    char text[MOST_TEXT]; /* the present line, without its end */
} table;

void table_open(table *t, const char *folder, const char *name);
int table_next(table *t); /* skips comments and empty lines; 0 at the end, and closes */
void table_stop(const table *t, const char *why) __attribute__((noreturn));

/* Cuts the line at '|' into exactly `count` fields without spaces around them. */
void table_fields(table *t, int count, char **fields);

/* Z of a symbol; the elements have to be written first. */
int table_element(const table *t, const char *symbol);

/* Each writes its tables. */
void write_cross_sections(const char *folder, FILE *out);
void write_elements(const char *folder, FILE *out); /* after the cross sections */
void write_mixtures(const char *folder, FILE *out); /* after the elements */
void write_k_shells(const char *folder, FILE *out);

/* Knots of each element: [first, last), filled by write_cross_sections. */
extern int first_knot[SKG_LAST_ELEMENT + 2];

#endif
