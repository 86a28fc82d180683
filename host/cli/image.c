/* skiagraph image */
#include "render.h"

#include "explain.h"

static const char *const quantity_names[] = {"energy", "fluence", "photons", "transmission", "attenuation"};
static const char *const quantity_units[] = {"keV per pixel", "keV/mm2", "per pixel", "I/I0", "-ln(I/I0)"};
static const char *const display_names[] = {"radiograph", "transmission"};

static const cli_flag flag_quantity = {"--quantity", "NAME",
                                       "energy (keV per pixel; default), fluence (keV/mm2), photons (per\n"
                                       "pixel), transmission (I/I0), attenuation (-ln I/I0)"};
static const cli_flag flag_display = {"--display", "CURVE",
                                      "of a .png: radiograph (-ln I/I0, dense is white; default) or\n"
                                      "transmission (I/I0, dense is dark)"};

static skg_status one_image(skg_plan *plan, const skg_output *output, const void *user) {
    (void)user;
    return skg_plan_image(plan, output);
}

static int run(const cli_arguments *arguments) {
    cli_rendering rendering = {.arguments = arguments, .frame = one_image};
    int32_t quantity = SKG_ENERGY, display = SKG_DISPLAY_RADIOGRAPH;
    int exit_status = cli_choice(arguments, &flag_quantity, quantity_names, 5, &quantity);
    if (exit_status == CLI_DONE)
        exit_status = cli_choice(arguments, &flag_display, display_names, 2, &display);
    if (exit_status == CLI_DONE) exit_status = cli_check_outputs(arguments);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, &rendering.session);
    if (exit_status == CLI_DONE) {
        rendering.session.options.quantity = quantity;
        skg_picture_init(&rendering.picture);
        rendering.picture.name = quantity_names[quantity];
        rendering.picture.unit = quantity_units[quantity];
        rendering.picture.quantity = quantity;
        rendering.picture.display = display;
        exit_status = cli_open_beam(&rendering.session, &rendering.picture.open);
    }
    if (exit_status == CLI_DONE) exit_status = cli_render(&rendering);
    cli_close_session(&rendering.session);
    return exit_status;
}

static const cli_flag *const flags[] = {&cli_flag_output,
                                        &flag_quantity,
                                        &flag_display,
                                        &cli_flag_range,
                                        &cli_flag_repeat,
                                        &cli_flag_device,
                                        &cli_flag_precision,
                                        &cli_flag_tolerance,
                                        &cli_flag_strategy,
                                        &cli_flag_set,
                                        &cli_flag_json,
                                        &cli_flag_quiet,
                                        NULL};

const cli_verb cli_image = {
    "image",
    "SCENE",
    "one X-ray image of a scene",
    "Writes one image to every -o: .png (16 bit grey, through --display and --range), .tif and .mha (floats,\n"
    "doubles with --precision double; .mha carries the detector's place). A file appears whole or not at all.\n"
    "--json prints {frame_ms, first_ms, plan_ms, stages, plan}; times are in ms.",
    1,
    1,
    flags,
    run};
