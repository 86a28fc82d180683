/* Shared work of `image` and `lbuffer`: plan, frames, files, report. */
#ifndef SKG_CLI_RENDER_H
#define SKG_CLI_RENDER_H

#include "session/beside.h"
#include "session/frames.h"
#include "session/scattering.h"
#include "session/session.h"

/* Data that a verb fills in before cli_render. */
typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    cli_frame frame;
    const void *frame_user;
    const char *channel_names[SKG_CHANNELS_MAX];
    cli_scattering *scattering; /* of an image; NULL: path lengths */
    cli_beside *beside;         /* likewise */
    int lengths;                /* 1: path lengths, which have one channel whatever the plan's images have */
    /* quantity and display, for path lengths also name and unit; cli_render fills in the rest */
    skg_picture picture;
} cli_rendering;

/* Before anything is computed, checks --repeat, --range and the extension of every -o. */
int cli_check_outputs(const cli_arguments *arguments);

/* Plans, computes the frames, writes every -o and prints. The caller closes the session. */
int cli_render(cli_rendering *rendering);

#endif
