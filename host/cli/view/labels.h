/* Names and measures on a 3D view, and its PNG file. */
#ifndef SKG_CLI_LABELS_H
#define SKG_CLI_LABELS_H

#include "view/place.h"

/* Draws the labels and the caption over the picture, rgba [rows][columns][4]. Returns an exit status and prints the
 * error. */
int view_label(const cli_session *session, const skg_look *look, const view_places *places, uint8_t *rgba);

/* Makes a PNG file of the picture, which the caller frees. Returns an exit status and prints the error. */
int view_encode(const skg_look *look, const uint8_t *rgba, char **bytes, size_t *count);

#endif
