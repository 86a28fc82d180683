/* How much the image changes when each part moves. */
#ifndef SKG_CLI_SENSITIVITY_H
#define SKG_CLI_SENSITIVITY_H

#include "session/session.h"

#include <jansson.h>

/* The root mean square over all pixels of the derivative of the image by a part's place, as a fraction of the open beam per mm. */
typedef struct {
    int64_t part; /* number in the scene */
    int is_known;
    double along[3];     /* x, y and z of the world */
    double direction[3]; /* the one that changes the image most */
    double largest;      /* along it */
} cli_part_sensitivity;

typedef struct {
    cli_part_sensitivity *parts; /* [count] the largest first, those that are not known last */
    int64_t count;
    int64_t saturated; /* slopes of faces that were cut off (skg_plan_derivatives) */
    double seconds;
    char refusal[512]; /* why it is not known; empty: it is */
} cli_sensitivity;

/* Measures all parts, until a signal asks to stop. The caller frees found->parts, also after a failure. Returns an exit status and
 * prints the error; what has no derivative is no error but a refusal.
 *
 * plan        of energies
 * frame       NULL: as plan and scene stand
 * flat_field  keV per pixel of the open beam */
int cli_sensitivity_measure(const cli_session *session, skg_plan *plan, const skg_frame *frame,
                            double flat_field, cli_sensitivity *found);

/* Notes why it is not known: the last error of the library. */
void cli_sensitivity_refuse(cli_sensitivity *found);

/* {unit, parts: [{part, x, y, z, largest, direction}], of, saturated, seconds, reason} */
json_t *cli_sensitivity_json(const cli_session *session, const cli_sensitivity *found);

#endif
