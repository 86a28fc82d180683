/* One view of a map, drawn into pixels. */
#ifndef SKG_CLI_MAP_PANEL_H
#define SKG_CLI_MAP_PANEL_H

#include <skiagraph/skiagraph.h>

typedef struct {
    const char *title;
    const skg_mesh *mesh;
    const double *distances; /* [vertices] mm */
} cli_map;

typedef struct {
    int width, height;
    unsigned char *pixels; /* [height][stride] blue, green, red, unused: Cairo's RGB24 */
    int stride;
} panel_pixels;

/* Draws the map over white. behind: 1 from behind, 0 from in front; the head is up in both. Returns an exit status and
 * prints the error. */
int panel_draw(const cli_map *map, int behind, double high_mm, const panel_pixels *to);

#endif
