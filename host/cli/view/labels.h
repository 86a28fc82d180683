/* Names and measures on a 3D view, and its PNG file. */
#ifndef SKG_CLI_LABELS_H
#define SKG_CLI_LABELS_H

#include "view/place.h"

/* Draws the labels and the caption over the picture and makes a PNG file of it. Returns an exit status and prints the
 * error.
 *
 * rgba    [rows][columns][4]
 * bytes   result: the file, which the caller frees */
int view_label(const cli_session *session, const skg_look *look, const view_places *places,
               const uint8_t *rgba, char **bytes, size_t *count);

#endif
