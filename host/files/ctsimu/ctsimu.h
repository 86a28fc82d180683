/* CTSimU scenarios (formats 1.0 to 1.2, https://bamresearch.github.io/ctsimu-scenarios), translated into scene files.
 * Private.
 *
 * The scene has the axes u, v, w of the stage, and its origin in the centre of the stage: source and detector turn
 * about w, samples on the stage stand still, and samples that are fixed in the world move. docs/ctsimu.md lists the
 * keys. */
#ifndef SKG_CTSIMU_H
#define SKG_CTSIMU_H

#include "json/json.h"

/* Where a file that the scenario names is read. */
typedef skg_status (*skg_ctsimu_find)(void *user, const char *name, const char **path);

/* Whether a file is a scenario: by its file_type, or by its keys. */
int skg_ctsimu_is(const skg_json_file *file);

/* Replaces the file's root by a scene; its text goes, because lines would mislead. Keys that are not simulated become
 * remarks. find: gives paths, with `user`. */
skg_status skg_ctsimu_translate(skg_json_file *file, skg_ctsimu_find find, void *user);

#endif
