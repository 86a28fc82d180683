/* skiagraph image */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const quantity_names[] = {"energy", "fluence", "photons", "transmission", "attenuation"};
static const char *const display_names[] = {"radiograph", "transmission"};

static const cli_flag flag_quantity = {"--quantity", "NAME",
                                       "energy (keV per pixel; default), fluence (keV/mm2), photons (per\n"
                                       "pixel), transmission (I/I0), attenuation (-ln I/I0)"};
static const cli_flag flag_display = {"--display", "CURVE",
                                      "of a .png: radiograph (-ln I/I0, dense is white; default) or\n"
                                      "transmission (I/I0, dense is dark)"};

static const cli_flag flag_bands = {"--bands", "KEV,KEV,...",
                                    "photon-counting bands by their edges: a channel from each to the next"};

/* "20,40,60" to edges. */
static int read_bands(const cli_arguments *arguments, double edges[SKG_CHANNELS_MAX + 1], int64_t *bands) {
    const char *value = cli_value(arguments, &flag_bands), *at = value;
    int64_t count = 0;
    while (at) {
        char *end = NULL;
        double edge = strtod(at, &end);
        if (end == at || (*end && *end != ',') || !(edge >= 0 && edge < HUGE_VAL) ||
            (count > 0 && !(edge > edges[count - 1])))
            return cli_error(CLI_USAGE, "--bands %s: \"%.*s\" is no energy in keV above the one before it",
                             value, (int)strcspn(at, ","), at);
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

static skg_status one_image(skg_plan *plan, const skg_output *output, const void *user) {
    (void)user;
    return skg_plan_image(plan, output);
}

static int run(const cli_arguments *arguments) {
    cli_rendering rendering = {.arguments = arguments, .frame = one_image};
    int32_t quantity = SKG_QUANTITY_ENERGY, display = SKG_DISPLAY_RADIOGRAPH;
    double edges[SKG_CHANNELS_MAX + 1];
    int64_t bands = 0;
    int exit_status = cli_choice(arguments, &flag_quantity, quantity_names, 5, &quantity);
    if (exit_status == CLI_DONE)
        exit_status = cli_choice(arguments, &flag_display, display_names, 2, &display);
    if (exit_status == CLI_DONE) exit_status = read_bands(arguments, edges, &bands);
    if (exit_status == CLI_DONE) exit_status = cli_check_outputs(arguments);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, &rendering.session);
    if (exit_status == CLI_DONE) {
        rendering.session.options.quantity = quantity;
        rendering.session.options.bands = bands;
        rendering.session.options.band_kev = edges;
        skg_picture_init(&rendering.picture);
        rendering.picture.quantity = quantity;
        rendering.picture.display = display;
        exit_status = cli_render(&rendering);
    }
    cli_close_session(&rendering.session);
    return exit_status;
}

static const cli_flag *const flags[] = {&cli_flag_output,    &flag_quantity,
                                        &flag_bands,         &flag_display,
                                        &cli_flag_range,     &cli_flag_repeat,
                                        &cli_flag_device,    &cli_flag_precision,
                                        &cli_flag_tolerance, &cli_flag_strategy,
                                        &cli_flag_set,       &cli_flag_json,
                                        &cli_flag_quiet,     NULL};

const cli_verb cli_image = {
    "image",
    "SCENE",
    "one X-ray image of a scene",
    "Writes one image to every -o: .png (16 bit grey, through --display and --range), .tif and .mha (floats,\n"
    "doubles with --precision double; .mha carries the detector's place). With --bands the image has a channel\n"
    "for each: .tif a page, .mha a component; a .png shows the first. A file appears whole or not at all.\n"
    "--json prints {frame_ms, first_ms, plan_ms, stages, plan}; times are in ms.",
    1,
    1,
    flags,
    run};
