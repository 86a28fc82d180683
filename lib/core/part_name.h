/* Names of files that are not finished: NAME.part-PID-TAG. Private.
 *
 * The tag is random for each process, because a process that is started again in a container often has the same number
 * as before, and two nodes that share a folder may have processes of the same number. */
#ifndef SKG_PART_NAME_H
#define SKG_PART_NAME_H

#include <stddef.h>

enum { SKG_PART_ENDING = 64 };

/* The ending of all unfinished files of this process; a number may follow it (skg_part_open). */
void skg_part_ending(char ending[SKG_PART_ENDING]);

/* Makes a file under a name that no other has, for reading and writing, and returns its descriptor.
 *
 * temporary   result: the name; at least strlen(path) + SKG_PART_ENDING bytes
 * failure     -1 with errno; EEXIST: `temporary` is the last of 100 names, which other files have */
int skg_part_open(const char *path, char *temporary);

/* 1: `name` is an unfinished file whose finished name ends in `end`, of whichever process. */
int skg_part_is_of(const char *name, const char *end);

#endif
