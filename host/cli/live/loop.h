/* The loop of the thread that computes: takes wishes, makes frames, answers. */
#ifndef CLI_LIVE_LOOP_H
#define CLI_LIVE_LOOP_H

#include "live/hub.h"
#include "live/lag.h"
#include "live/registering.h"
#include "live/scene.h"

typedef struct {
    live_base base;
    live_scene scene; /* the last one that could be made */
    live_wish wish;   /* which it shows */
    live_lag lag;     /* of the detector, over all scenes */
    live_hub *hub;
    live_registering *registering; /* NULL: none is under way */
    const char *nonce;
    int64_t number;    /* of the last frame */
    int64_t geometry;  /* of the page */
    double scatter_s;  /* that the scatter of a whole frame took; 0: unknown */
    int again;         /* 1: another frame of the wish is wanted when nothing else is */
    int is_shown;      /* 1: the last frame was not dropped, and did not fail */
    int is_wanted;     /* 1: a frame of the wish is still to be made */
    int is_told;       /* 1: pages that begin are told of this wish */
    double looked_ms;  /* when the files were last looked at */
    double played_ms;  /* when the last frame that plays was posed; 0: it does not play */
    double told_ms;    /* when pages were last told all of a frame */
    int64_t told;      /* its wish */
    double framed_ms;  /* when the last frame was made */
    double picture_ms; /* when the next picture of the 3D view may be drawn */
} live_loop;

/* Reads the scene, makes its page and its first frame. Returns an exit status and prints the error. */
int live_loop_begin(live_loop *loop, const char *nonce);

/* Runs until a signal, or until nothing was asked for during `idle` s; 0: without end. */
void live_loop_run(live_loop *loop, double idle);

/* Frees everything but the context. */
void live_loop_end(live_loop *loop);

#endif
