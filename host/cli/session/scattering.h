/* Scattered photons of an image: the flags that ask for them, and what is reported of them. */
#ifndef SKG_CLI_SCATTERING_H
#define SKG_CLI_SCATTERING_H

#include "session/session.h"

#include <jansson.h>

typedef struct {
    skg_scatter asked; /* what the options of the session point to */
    int is_asked;      /* 1: by a flag */
    int has_accuracy;  /* 1: a flag gives the tolerance or the histories of `asked` */
} cli_scattering;

/* Reads the flags. Returns an exit status and prints the error. */
int cli_scattering_read(const cli_arguments *arguments, cli_scattering *scattering);

/* Puts the flags over the key Scatter of the session's scene. */
void cli_scattering_ask(cli_scattering *scattering, cli_session *session);

/* The object under the key "scatter", null if the plan has none, and the same as a line. */
json_t *cli_scattering_json(const skg_plan *plan, const skg_picture *image);
void cli_scattering_print(const skg_plan *plan, const skg_picture *image);

#endif
