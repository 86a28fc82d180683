/* The scene as the last wish has it, ready for frames. Functions that return 0 have a sentence that says why. */
#ifndef CLI_LIVE_SCENE_H
#define CLI_LIVE_SCENE_H

#include "live/wish.h"
#include "register/work.h"
#include "session/session.h"

/* The scene file and what the command line changes in it. */
typedef struct {
    const cli_arguments *arguments;
    skg_context *context;
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

typedef struct {
    skg_setup *setup;
    cli_session session; /* of this set-up; it owns nothing */
    skg_motion *motion;  /* NULL: the scene does not breathe */
    double period;       /* of the breath, s */
    skg_scan *scan;      /* of the set-up; NULL: there is none */
    live_wish wish;      /* with which it was read */
    int64_t parts, projections;
    double load_ms;
    skg_view view;            /* source and detector of the wish that is shown */
    skg_live_subject subject; /* all of these for the library */
    skg_live_plans *plans;    /* NULL: it was loaded only */
    json_t *dose;             /* of the view `dose_view`; NULL: not computed yet */
    skg_view dose_view;
    double dose_phase;
} live_scene;

/* Loads the scene, without a plan. The caller calls live_scene_free, also after a failure. The scene stays where it is: its subject points
 * into it. */
int live_scene_load(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence);

/* Loads and plans. The caller calls live_scene_free, also after a failure. */
int live_scene_make(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence);
void live_scene_free(live_scene *scene);

/* Puts a scene elsewhere. */
void live_scene_move(live_scene *from, live_scene *to);

/* Finds source and detector of a wish. */
int live_scene_see(const live_base *base, live_scene *scene, const live_wish *wish, char *sentence);

#endif
