/* Rays that are traced again, through meshes and the caps of their holes. Private. */
#ifndef SKG_RETRACE_H
#define SKG_RETRACE_H

#include "geometry/optics.h"
#include "mesh/mesh.h"

/* --- Caps that close a leaky mesh: a fan over each loop of open edges, about the mean of the loop. *
 * Cracks come first: vertices at rims that nearly touch stand for each other (rims.c), each open edge moves to them, and a strip
 * closes the way that it went. Plane patches of a surface that nobody welded would else be closed by their own reverse, and vanish.
 * Mesh and caps together are closed as a sum of signed triangles, whatever is wrong with the mesh, so that the
 * signed hits of every ray cancel. A plane loop is capped by exactly the area that it bounds. A missing triangle
 * and any plane hole are therefore closed exactly, and the gap at a T-junction gets the sliver that is missing.
 * A flipped triangle bounds its loop twice, and the two triangles of its caps outweigh it. Over a loop that is
 * not plane, the fan is one of many possible surfaces. */

typedef struct {
    int64_t loops;
    int64_t *first;    /* [loops + 1] into vertices */
    int32_t *vertices; /* of the mesh, in the direction of the triangles along each loop */
} skg_caps;

skg_status skg_caps_find(const skg_mesh *mesh, skg_caps *caps);

/* Finds vertices at rims that stand for each other, because less than a crack is between them; the caller frees *stands_for.
 *
 * edges        [count][2] open edges, sorted by their start
 * stands_for   result: [vertices of the mesh] of those at rims the vertex that stands for it, often itself; else -1 */
skg_status skg_rims_weld(const skg_mesh *mesh, int64_t count, const int32_t *edges, int32_t **stands_for);
void skg_caps_release(skg_caps *caps);

/* Finds the pieces that enclose nothing with their caps, as a plane sheet does: how many, and their area in mm2, of one side. */
skg_status skg_caps_sheets(const skg_mesh *mesh, const skg_caps *caps, int64_t *count, double *area);

/* --- Rays through a leaky mesh, traced again on the host in double, through the mesh and its caps. */

/* A list of pixels, by rows. */
typedef struct {
    int64_t count;
    int64_t *first;   /* [rows + 1] into columns */
    int32_t *columns; /* [count] rising within a row */
} skg_pixel_list;

/* Lists the pixels of the rows first to end - 1 that are not 0 in marks [rows][columns]. */
skg_status skg_pixel_list_make(int64_t columns, int64_t rows, int64_t first, int64_t end,
                               const int32_t *marks, skg_pixel_list *list);
void skg_pixel_list_release(skg_pixel_list *list);

/* Sets paths[k] to the share of the length of the ray to pixel k of the list that lies in the mesh: 0 to 1 if its
 * triangles face outward. pose: 4x4, row by row. */
skg_status skg_recast(const skg_camera *camera, const skg_mesh *mesh, const skg_caps *caps,
                      const double *pose, const skg_pixel_list *pixels, double *paths);

/* Sets marks [rows][columns] to 1 where a ray passes a cap, or may pass it on a device that rounds. */
void skg_recast_mark(const skg_camera *camera, const skg_mesh *mesh, const skg_caps *caps, const double *pose,
                     int32_t *marks);

#endif
