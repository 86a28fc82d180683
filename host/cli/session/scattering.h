/* Scattered photons of an image: the flags that ask for them, their own pictures, and what is reported of them. */
#ifndef SKG_CLI_SCATTERING_H
#define SKG_CLI_SCATTERING_H

#include "session/session.h"

#include <jansson.h>

enum { CLI_SCATTERED, CLI_SCATTERED_SIGMA, CLI_SCATTERED_COUNT };

typedef struct {
    skg_scatter asked;                      /* what the options of the session point to */
    int is_asked;                           /* 1: by a flag */
    int has_accuracy;                       /* 1: a flag gives the tolerance or the histories of `asked` */
    const char *paths[CLI_SCATTERED_COUNT]; /* NULL: this picture is not wanted */
    void *planes[CLI_SCATTERED_COUNT];
} cli_scattering;

/* Reads the flags. Returns an exit status and prints the error, as all functions here that return int. */
int cli_scattering_read(const cli_arguments *arguments, cli_scattering *scattering);

/* Puts the flags over the key Scatter of the session's scene. */
void cli_scattering_ask(cli_scattering *scattering, cli_session *session);

/* Memory for the pictures, which hold what the image holds. The caller frees it. */
int cli_scattering_allocate(const cli_session *session, int32_t type, cli_scattering *scattering);
void cli_scattering_free(cli_scattering *scattering);

/* A cli_frame: the image, and the pictures that are wanted. user: the cli_scattering */
skg_status cli_scattering_frame(skg_plan *plan, const skg_output *output, const void *user);

/* Writes the pictures. image: the picture to which they belong. */
int cli_scattering_write(const cli_scattering *scattering, const skg_picture *image);

/* The object under the key "scatter", null if the plan has none, and the same as a line. */
json_t *cli_scattering_json(const skg_plan *plan, const skg_picture *image);
void cli_scattering_print(const skg_plan *plan, const skg_picture *image);

#endif
