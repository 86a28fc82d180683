/* The 3D view as the server draws it, for pages whose browser draws slowly. */
#ifndef CLI_LIVE_PICTURE_H
#define CLI_LIVE_PICTURE_H

#include "live/look.h"
#include "live/scene.h"

/* What a page receives as a picture: this, in the order of the processor, and [rows][columns][4] red, green, blue and 255. */
typedef struct {
    char mark[4];           /* "SKLP" */
    uint32_t number;        /* of the look */
    uint16_t columns, rows; /* 0: it could not be drawn */
    float ms;
} live_picture_header;

/* Draws the scene as it is posed, with the last frame on the detector. wish: its poses and projection are those of the parts. The
 * bytes, for live_hub_picture, are made in any case but without memory; returns 0 with a sentence if there is no picture in
 * them. */
int live_picture_make(live_scene *scene, const live_wish *wish, const live_look *look, unsigned char **bytes,
                      size_t *size, char *sentence);

/* Finds the box of the parts, for the axes and the beam, which stay where they are while parts move. Returns 0 with a sentence. */
int live_picture_box(live_scene *scene, char *sentence);

#endif
