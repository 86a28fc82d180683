/* What the verb fit works on. Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_FIT_WORK_H
#define SKG_CLI_FIT_WORK_H

#include "common/args.h"

#include <jansson.h>
#include <skiagraph/skiagraph.h>

typedef struct {
    const cli_arguments *arguments;
    skg_setup *setup;
    skg_scene *scene; /* owned by the set-up */
    skg_fit *fit;
    skg_fit_state state;
    double seconds; /* of the search */
} fit_work;

/* The scene of the first operand, or of another file. */
int fit_load_scene(const cli_arguments *arguments, const char *path, int with_settings, skg_setup **setup);

/* Makes the fit, with targets and flags. */
int fit_prepare(fit_work *work);

/* The file of -o with an extension, or NULL. */
const char *fit_output(const fit_work *work, const char *extension);

#endif
