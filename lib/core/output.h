/* Files that appear whole or not at all: they are written under a temporary name in the same folder, synced and
 * renamed. Private. */
#ifndef SKG_OUTPUT_H
#define SKG_OUTPUT_H

#include "core/core.h"

#include <stdio.h>

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

/* The same where skg_part_open failed; the sentence names the leftover that is in the way. */
skg_status skg_output_part_fail(const char *path, const char *temporary, int reason);

/* Syncs, closes and renames the file. On failure no file is left. */
skg_status skg_output_commit(skg_output_file *file);

/* Closes and removes the temporary file. Does nothing after a commit or a failed open. */
void skg_output_discard(skg_output_file *file);

#endif
