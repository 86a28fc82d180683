/* The surfaces of a scene for a page, at one moment or at several. Functions that return int return an exit status and print
 * the error. */
#ifndef SKG_CLI_SHAPES_H
#define SKG_CLI_SHAPES_H

#include "view/thin.h"

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
