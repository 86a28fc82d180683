/* Checks the lengths that the arrays of a COLLADA file announce. Private. */
#ifndef SKG_MESH_COLLADA_LENGTHS_H
#define SKG_MESH_COLLADA_LENGTHS_H

#include "core/core.h"

/* Fails as skg_mesh_check_counts does. text: ends in a zero */
skg_status skg_mesh_check_collada_lengths(const char *path, const char *text);

#endif
