/* Frames of a scene, and how they travel. */
#ifndef CLI_LIVE_FRAME_H
#define CLI_LIVE_FRAME_H

#include "live/hub.h"
#include "live/lag.h"
#include "live/scene.h"

/* What a page receives as a frame: this, in the order of the processor, and [rows][columns] numbers of 16 bits. A value is
 * low + step * number. */
typedef struct {
    char mark[4];    /* "SKLF"; of the radiograph of --fixed "SKLR" */
    uint32_t number; /* of the frame */
    uint32_t wish;   /* of the wish that it shows */
    uint16_t columns, rows;
    double low, step;
    double flat_field; /* of the values' unit; 0: the values are -ln(I/I0) */
    float ms;          /* from the pose to the image */
    uint16_t factor;   /* pixels of the detector for each of the frame, along a side */
    uint8_t quantity;  /* enum skg_quantity */
    uint8_t notes;     /* LIVE_NOTE_... */
} live_header;

enum { LIVE_NOTE_DRAFT = 1, LIVE_NOTE_INFINITE = 2, LIVE_NOTE_RANGE = 4, LIVE_NOTE_REFINES = 8 };

/* A frame. */
typedef struct {
    unsigned char *bytes; /* for live_hub_show; NULL: there is no image */
    size_t size;
    double ms;
    skg_view view;  /* of the whole detector */
    int is_dropped; /* a newer wish came before the image was begun */
} live_shot;

/* Header and 16-bit numbers of values; low, step and LIVE_NOTE_INFINITE are written into the header. The caller frees the bytes. Returns
 * 0 without memory. */
int live_frame_pack(const float *values, live_header *header, unsigned char **bytes, size_t *size);

/* Makes the image of a wish that fits the scene. lag: of the detector; images with fewer pixels pass it by. hub: asked for newer wishes.
 * Returns 0 with a sentence. */
int live_frame_make(const live_base *base, live_scene *scene, const live_wish *wish, live_lag *lag,
                    live_hub *hub, int64_t number, live_shot *shot, char *sentence);

/* Puts a frame's view, poses and matter together and renders it into `values`. plan: the scene's, or its draft with the view that
 * goes with it. hub: may be NULL. Returns 0 with a sentence; *dropped: 1 if a newer wish came. */
int live_frame_render(const live_scene *scene, const live_wish *wish, skg_plan *plan, const skg_view *view,
                      live_hub *hub, const skg_output *outputs, int64_t output_count, int *dropped,
                      int *is_outside, char *sentence);

/* The poses of all parts, [parts][16]. Returns 0 with a sentence. */
int live_frame_poses(const live_scene *scene, const live_wish *wish, double *poses, char *sentence);

/* Puts the parts of a scene without a plan where the wish has them. Returns 0 with a sentence. */
int live_frame_place(live_scene *scene, const live_wish *wish, char *sentence);

/* Poses the breath of a wish. */
int live_frame_pose(live_scene *scene, const live_wish *wish, char *sentence);

#endif
