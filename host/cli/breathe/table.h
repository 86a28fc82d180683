/* motion.csv: its heading, and a line of the motion for each frame, which is in the file as soon as the frame is. Functions that return int return an exit
 * status and print the error. */
#ifndef SKG_CLI_TABLE_H
#define SKG_CLI_TABLE_H

#include "breathe/fluoroscopy.h"

#include <stdio.h>

typedef struct {
    const char *path; /* the caller's */
    FILE *stream;
} motion_table;

int table_open(const char *path, motion_table *table);

/* Adds a line of the motion in its present pose. */
int table_add(const fluoroscopy *f, double time_s, motion_table *table);

/* Does nothing if the table is not open. */
int table_close(motion_table *table);

#endif
