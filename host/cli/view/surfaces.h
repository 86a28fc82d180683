/* The surfaces of a scene for a page, with fewer triangles, at one moment or at several. Functions that return int
 * return an exit status and print the error. */
#ifndef CLI_VIEW_SURFACES_H
#define CLI_VIEW_SURFACES_H

#include <skiagraph/skiagraph.h>

/* Surfaces of parts with fewer triangles, by meshoptimizer. */

typedef struct {
    int64_t vertices, triangles;
    int64_t of;       /* triangles that the part has */
    int32_t *origin;  /* [vertices] numbers of the part's own vertices, which are kept where they are */
    int32_t *corners; /* [triangles][3] */
} view_surface;

/* Whether this build has meshoptimizer. Without it surfaces keep all triangles. */
extern const int view_can_thin;

/* Joins vertices at the same place and removes edges until there are about `wanted` triangles; it may stop before, where the
 * surface would change its kind. A part with fewer triangles keeps them all. The caller calls view_surface_free, also after a
 * failure. */
int view_thin(const skg_part *part, int64_t wanted, view_surface *surface);
void view_surface_free(view_surface *surface);

typedef struct {
    view_surface surface;
    float *positions; /* [frames][surface.vertices][3] mm, in the world */
    int moves;        /* 0: all frames are as the first */
} view_shape;

typedef struct {
    view_shape *shapes;
    int64_t count, frames;
    int64_t triangles, of; /* shown, and in the scene */
} view_shapes;

/* Chooses the triangles to show, at most about `most` of all parts. The caller calls view_shapes_free, also after a failure. */
int view_shapes_make(const skg_scene *scene, int64_t frames, int64_t most, view_shapes *shapes);

/* Takes the positions that the scene has now as those of a frame. Frames come in order. */
int view_shapes_take(const skg_scene *scene, int64_t frame, view_shapes *shapes);
void view_shapes_free(view_shapes *shapes);

#endif
