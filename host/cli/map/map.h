/* Pictures of maps: surfaces in the colours of their distances, from in front and from behind. */
#ifndef SKG_CLI_MAP_H
#define SKG_CLI_MAP_H

#include "map/panel.h"

#include <stddef.h>

/* Draws maps below each other, with one scale from 0 to high_mm, as a PNG in memory, which the caller frees. Returns an
 * exit status and prints the error. */
int cli_map_png(const cli_map *maps, int count, double high_mm, unsigned char **png, size_t *size);

/* A value at least as large as this one with one digit of 1, 2 or 5, at which a scale may end. */
double cli_map_end(double value);

#endif
