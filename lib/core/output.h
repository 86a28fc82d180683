/* Files that appear whole or not at all: written under a temporary name in the same folder, synced, renamed.
 * Private. */
#ifndef SKG_OUTPUT_H
#define SKG_OUTPUT_H

#include "core/core.h"

#include <stdio.h>

typedef struct {
    FILE *stream; /* write here */
    char *path, *temporary;
} skg_output_file;

/* Opens the temporary file. A folder or device of that name is refused. */
skg_status skg_output_open(const char *path, skg_output_file *file);

/* SKG_ERR_OUTPUT with path, reason (of an errno value; otherwise as the writer's library gave it) and mend.
 */
skg_status skg_output_fail(const char *path, int reason, const char *otherwise);

/* Syncs, closes and renames; on failure nothing is left. */
skg_status skg_output_commit(skg_output_file *file);

/* Closes and removes the temporary file; fine after commit or a failed open. */
void skg_output_discard(skg_output_file *file);

#endif
