/* What `image` and `lbuffer` share: outputs that can be written, a plan, frames, files, and what is printed.
 */
#ifndef SKG_CLI_RENDER_H
#define SKG_CLI_RENDER_H

#include "scene/frames.h"
#include "scene/session.h"

/* What a verb fills in before cli_render. */
typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    cli_frame frame;
    const void *frame_user;
    const char *channel_names[SKG_CHANNELS_MAX];
    int lengths;         /* 1: one channel, whatever the plan's images have */
    skg_picture picture; /* quantity and display, of lengths also name and unit; the rest is filled in here */
} cli_rendering;

/* Checks --repeat and --range, and that every -o can be written: before anything is computed. */
int cli_check_outputs(const cli_arguments *arguments);

/* Plans, runs the frames, writes every -o, prints. The session stays open. */
int cli_render(cli_rendering *rendering);

#endif
