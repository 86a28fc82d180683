/* Scenes that are written: what their files are called from another folder. Private. */
#ifndef SKG_SETUP_SAVE_H
#define SKG_SETUP_SAVE_H

#include "setup/types.h"

#include <jansson.h>

/* Replaces the names of files in a value of a scene's text, and in everything below it, by those that lead there from a scene at `path`. */
void skg_setup_rename_files(const skg_setup *setup, const char *path, json_t *value);

/* Writes an object as a file, which appears whole or not at all. */
skg_status skg_setup_write_json(const json_t *object, const char *path);

/* Writes a text as a scene file, which appears whole or not at all. */
skg_status skg_setup_write_text(json_t *scene, const char *path);

#endif
