/* The verb `mesh` for a volume of cells. Private. */
#ifndef CLI_MESH_VOLUME_H
#define CLI_MESH_VOLUME_H

#include <jansson.h>

#include <skiagraph/skiagraph.h>

/* Whether a file is a volume by its extension. */
int cli_is_volume(const char *path);

/* Prints what a volume is, or adds it to a list. unit_mm: 0: mm; list: NULL: it is printed */
skg_status cli_mesh_volume(const char *path, double unit_mm, json_t *list);

#endif
