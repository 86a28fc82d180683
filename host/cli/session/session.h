/* A device and the scene that was read for it. */
#ifndef SKG_CLI_SESSION_H
#define SKG_CLI_SESSION_H

#include "common/args.h"

#include <skiagraph/skiagraph.h>

typedef struct {
    skg_context *context;
    skg_device_info device;
    skg_setup *setup;
    skg_scene *scene;       /* owned by the set-up, or `chosen` */
    skg_scene *chosen;      /* of its own, with some of the parts; or NULL */
    skg_spectrum *spectrum; /* owned by the set-up */
    skg_view view;
    skg_plan_options options;
    const char *path;
} cli_session;

/* Opens the device and reads the scene, the first operand, with --set, --lenient, --precision, --tolerance and --strategy
 * applied. lengths_only: 1 if a scene without beam or materials will do. The caller closes the session, also after a failure.
 * Returns an exit status and prints the error. */
int cli_open_session(const cli_arguments *arguments, int lengths_only, cli_session *session);

/* Fails if the scene's detector counts photons, which gives images of several windows. what: "breathe", a verb that shows one image */
int cli_refuse_counting(const cli_session *session, const char *what);
void cli_close_session(cli_session *session);

/* Says that photons are counted absolutely and nevertheless have no noise: of verbs whose pixels are the result, so that it stands
 * there and in the table of `plan`, and not before every command. */
void cli_note_no_noise(const cli_session *session);

#endif
