/* Pictures beside an image, each by a flag with the name of its file: what was scattered, its error, the mean, and the variance of
 * the noise. */
#ifndef SKG_CLI_BESIDE_H
#define SKG_CLI_BESIDE_H

#include "session/session.h"

enum { CLI_BESIDE_SCATTER, CLI_BESIDE_SIGMA, CLI_BESIDE_MEAN, CLI_BESIDE_VARIANCE, CLI_BESIDE_COUNT };

typedef struct {
    const char *paths[CLI_BESIDE_COUNT]; /* NULL: this picture is not wanted */
    void *planes[CLI_BESIDE_COUNT];
} cli_beside;

/* Reads the flags. */
void cli_beside_read(const cli_arguments *arguments, cli_beside *beside);

/* Memory for the pictures, which hold what the image holds. The caller frees it. Returns an exit status and prints the error. */
int cli_beside_allocate(const cli_session *session, int32_t type, cli_beside *beside);
void cli_beside_free(cli_beside *beside);

/* A cli_frame: the image, and the pictures that are wanted. user: the cli_beside */
skg_status cli_beside_frame(skg_plan *plan, const skg_output *output, const void *user);

/* Writes the pictures. image: the picture to which they belong. Returns an exit status and prints the error. */
int cli_beside_write(const cli_beside *beside, const skg_picture *image);

#endif
