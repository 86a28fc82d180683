/* Timed frames: the first one, and then the warm ones that --repeat asks for. */
#ifndef SKG_CLI_FRAMES_H
#define SKG_CLI_FRAMES_H

#include <skiagraph/skiagraph.h>

#include <jansson.h>

enum { CLI_STAGES_MAX = 32 };

typedef struct {
    char name[64];
    double *ms; /* [repeats] */
    int64_t count;
} cli_stage_times;

typedef struct {
    double plan_ms, first_ms;
    int64_t repeats;
    double *frame_ms; /* [repeats], wall time from the submission to the image in host memory */
    cli_stage_times stages[CLI_STAGES_MAX];
    int stage_count;
} cli_times;

/* The exit status after an image. Warns of path lengths outside the verified range; warned: set to 1 by the
 * first warning, after which there are no more; NULL: warns every time. */
int cli_end_image(skg_status status, int *warned);

/* Submits one frame into the caller's output and waits for it. */
typedef skg_status (*cli_frame)(skg_plan *plan, const skg_output *output, const void *user);

/* Runs 1 + times->repeats frames. The caller frees the times. Returns an exit status. */
int cli_run_frames(skg_plan *plan, cli_frame frame, const skg_output *output, const void *user,
                   cli_times *times);
void cli_times_free(cli_times *times);

/* Adds frame_ms, first_ms, plan_ms and stages to an object; what was not measured is null. */
void cli_times_json(const cli_times *times, json_t *object);
void cli_times_print(const cli_times *times);

#endif
