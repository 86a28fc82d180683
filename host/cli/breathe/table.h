/* motion.csv: its heading, and a line of the motion for each frame. Functions that return int return an exit
 * status and print the error. */
#ifndef SKG_CLI_TABLE_H
#define SKG_CLI_TABLE_H

#include "breathe/fluoroscopy.h"

#include <stdio.h>

typedef struct {
    char *path, *temporary;
    FILE *stream;
} motion_table;

int table_open(const char *path, motion_table *table);

/* Adds a line of the motion in its present pose. */
int table_add(const fluoroscopy *f, double time_s, motion_table *table);

/* The file appears. */
int table_close(motion_table *table);

/* Frees the table, and removes a file that was not closed. */
void table_discard(motion_table *table);

#endif
