/* The verb `image`: an X-ray image of a scene. */
#include "verbs/verbs.h"

#include "common/say.h"
#include "session/chosen.h"
#include "session/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Reads "20,40,60". */
static int read_bands(const cli_arguments *arguments, double edges[SKG_CHANNELS_MAX + 1], int64_t *bands) {
    const char *value = cli_value(arguments, "--bands"), *at = value;
    int64_t count = 0;
    while (at) {
        char *end = NULL;
        double edge = strtod(at, &end);
        if (end == at || (*end && *end != ',') || !(edge >= 0 && edge < HUGE_VAL) ||
            (count > 0 && !(edge > edges[count - 1])))
            return cli_error(CLI_USAGE,
                             "--bands %s: \"%.*s\" is not an energy in keV above the one before it", value,
                             (int)strcspn(at, ","), at);
        if (count > SKG_CHANNELS_MAX)
            return cli_error(CLI_USAGE, "--bands %s: more than %d bands", value, SKG_CHANNELS_MAX);
        edges[count++] = edge;
        at = *end ? end + 1 : NULL;
    }
    if (count == 1)
        return cli_error(CLI_USAGE, "--bands %s: one edge makes no band; give two or more", value);
    *bands = count > 0 ? count - 1 : 0;
    return CLI_DONE;
}

int cli_image(const cli_arguments *arguments) {
    cli_scattering scattering = {0};
    cli_beside beside = {0};
    cli_rendering rendering = {.arguments = arguments,
                               .frame = cli_beside_frame,
                               .frame_user = &beside,
                               .scattering = &scattering,
                               .beside = &beside};
    int32_t quantity = -1, display = SKG_DISPLAY_RADIOGRAPH, weight = -1;
    double edges[SKG_CHANNELS_MAX + 1];
    int64_t bands = 0;
    int exit_status = cli_choice(arguments, "--quantity", &quantity);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--display", &display);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--band-weight", &weight);
    if (exit_status == CLI_DONE) exit_status = read_bands(arguments, edges, &bands);
    if (exit_status == CLI_DONE && weight >= 0 && bands == 0)
        exit_status = cli_error(CLI_USAGE, "--band-weight weighs the photons of bands; add --bands");
    if (exit_status == CLI_DONE) exit_status = cli_scattering_read(arguments, &scattering);
    cli_beside_read(arguments, &beside);
    if (exit_status == CLI_DONE) exit_status = cli_check_outputs(arguments);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 0, &rendering.session);
    if (exit_status == CLI_DONE) cli_note_no_noise(&rendering.session);
    if (exit_status == CLI_DONE) exit_status = cli_choose_parts(arguments, &rendering.session);
    if (exit_status == CLI_DONE) {
        cli_scattering_ask(&scattering, &rendering.session);
        if (quantity >= 0) rendering.session.options.quantity = quantity;
        rendering.session.options.bands = bands;
        rendering.session.options.band_kev = edges;
        if (weight >= 0) rendering.session.options.band_weight = weight;
        skg_picture_init(&rendering.picture);
        rendering.picture.quantity = rendering.session.options.quantity;
        rendering.picture.display = display;
        exit_status = cli_render(&rendering);
    }
    cli_close_session(&rendering.session);
    cli_beside_free(&beside);
    return exit_status;
}
