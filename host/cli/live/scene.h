/* The scene as the last wish has it, ready for frames. Functions that return 0 have a sentence that says why. */
#ifndef CLI_LIVE_SCENE_H
#define CLI_LIVE_SCENE_H

#include "live/wish.h"
#include "register/work.h"
#include "session/session.h"

#include <skiagraph/breathing.h>

/* The scene file and what the command line changes in it. */
typedef struct {
    const cli_arguments *arguments;
    skg_context *context;
    skg_device_info device;
    const char *path;
    int32_t precision;     /* -1: the scene's */
    char *text;            /* the scene file after the settings of the command line, as JSON */
    register_image *fixed; /* the radiograph of --fixed; NULL: there is none */
    json_t *warnings;      /* [sentence] of the library about the last scene that was made */
    int64_t file_count;
    char **files;    /* [file_count] that were read, the scene's own first */
    int64_t *stamps; /* [file_count] when they were changed, in ns */
} live_base;

/* Reads the file, again if it was read before. */
int live_base_read(live_base *base, char *sentence);

/* Whether one of the files has changed since it was read. */
int live_base_is_stale(const live_base *base);
void live_base_free(live_base *base);

/* Plans with fewer histories of scatter than the scene asks for, whose images come first. */
enum { LIVE_STEPS = 5 };

typedef struct {
    skg_setup *setup;
    cli_session session; /* of this set-up; it owns nothing */
    skg_motion *motion;  /* NULL: the scene does not breathe */
    double period;       /* of the breath, s */
    int is_posed;        /* 1: the meshes are no longer where the file has them */
    skg_plan *plan;
    skg_plan *draft;             /* for images while something is dragged; NULL: the plan serves */
    int is_drafted;              /* 1: a draft was made, or could not be */
    int64_t factor;              /* pixels of the detector for each of the draft, along a side */
    skg_plan *steps[LIVE_STEPS]; /* NULL: not made yet */
    int step;                    /* of the next frame; LIVE_STEPS: it is made by `plan` */
    const skg_plan *shown_plan;  /* of the last frame */
    json_t *settings;            /* of the wish with which it was made */
    skg_channel channel;         /* what the images hold; of bands the first */
    int64_t channels;            /* bands, or 1 */
    double *band_kev;            /* [channels + 1] edges of the bands; NULL: there are none */
    int64_t parts, projections;
    double load_ms, plan_ms;
    /* of the last whole image but the first, for which kernels are made; 0: there is none yet */
    double frame_ms;
    int64_t frames; /* whole images so far */
    float *values;  /* [channels][rows][columns] of an image */
    int is_shown;   /* 1: `values` is a whole image: channel shown_channel of the view `shown` is shown */
    int64_t shown_channel, shown_wish; /* shown_wish: number of the wish of the last frame */
    skg_view shown;
    double shown_flat; /* its flat field; 0: the values are -ln(I/I0) */
    double box[6];     /* least and greatest corner of the parts, mm, where has_box */
    int has_box;
    skg_view beam_view; /* view of `beam`; all 0: not computed yet */
    skg_quality beam;   /* the open beam, cached because it takes 0.1 ms */
    int has_beam;
    json_t *dose; /* of the view `dose_view`; NULL: not computed yet */
    skg_view dose_view;
    double dose_phase;
} live_scene;

/* Loads the scene, without a plan. The caller calls live_scene_free, also after a failure. */
int live_scene_load(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence);

/* Loads and plans. The caller calls live_scene_free, also after a failure. */
int live_scene_make(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence);
void live_scene_free(live_scene *scene);

/* Whether frames of this scene can show a wish; otherwise it has to be made anew. */
int live_scene_fits(const live_scene *scene, const live_wish *wish);

/* The view of a wish. */
int live_scene_view(const live_base *base, const live_scene *scene, const live_wish *wish, skg_view *view,
                    char *sentence);

/* Makes pixels larger: `factor` of them along a side become one, of the same detector. */
void live_view_coarsen(skg_view *view, int64_t factor);

/* Makes the plan for images while something is dragged: fewer pixels, so that an image takes about `ms`, and no scatter. */
int live_scene_draft(const live_base *base, live_scene *scene, double ms, char *sentence);

/* The plan of the next frame; the draft is another. Returns 0 with a sentence. */
int live_scene_step(live_scene *scene, skg_plan **plan, char *sentence);

/* Begins the steps of a frame's scatter. seconds: that it took last; 0: unknown. Fast scatter is computed at once. */
void live_scene_refine(live_scene *scene, double seconds);

#endif
