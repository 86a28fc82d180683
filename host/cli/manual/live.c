/* The manual of `live`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag live_port = {"--port", "N",
                                   "The port to listen on; by default, and with 0, one that is free.", NULL,
                                   CLI_NAMES_NOTHING};
static const cli_flag live_no_open = {
    "--no-open", NULL, "Does not open a browser. Without a graphical desktop none is opened anyway.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag live_bind = {
    "--bind", "ADDRESS",
    "The address to listen on, 127.0.0.1 by default: this machine alone. With another one whoever has the printed "
    "address can see and change the scene, and a warning says so.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag live_idle = {
    "--idle", "SECONDS", "Ends when no page has asked for anything for so long.", NULL, CLI_NAMES_NOTHING};

static const cli_flag live_fixed = {
    "--fixed", "FILE[@K]",
    "A radiograph that lies over the image, and to which the chosen part is registered by a button: .mha, .mhd, .tif, .png or .dcm. K is "
    "the projection of the scene's Scan that it was taken from, and the page of a file that has several; without it the view is that of "
    "the scene's Source and Detector.",
    NULL, CLI_NAMES_FILE};

static const char *const text[] = {
    "Serves a page in which the scene can be changed while its X-ray image follows: parts, source and detector are "
    "dragged, beam, noise, breath and every other key of the scene file are set, and each image says what it costs. The "
    "first line on standard output is the address, http://127.0.0.1:PORT/?token=TOKEN. Without the token every answer "
    "is 403.",
    "The page listens on this machine only. From another one, ssh -L PORT:localhost:PORT makes it reachable. A second "
    "page shows the scene and cannot change it. No file is changed: what was made of the scene is taken away from the "
    "page, as scene file, command line, Python script or image.",
    "With --fixed the page shows a radiograph over the image, or the difference, and registers the chosen part to it as the verb register "
    "does: while it goes on, the page stays usable, and a button ends it. The pose that was found can be undone.",
    "When the scene file changes, the page follows. Ctrl-C ends, as does the end of the terminal.",
    "--json prints {url, port, token}.",
    NULL};

static const cli_flag *const flags[] = {&live_port,
                                        &live_no_open,
                                        &live_bind,
                                        &live_idle,
                                        &live_fixed,
                                        &cli_flag_register_quantity,
                                        &cli_flag_register_flat,
                                        &cli_flag_device,
                                        &cli_flag_precision,
                                        &cli_flag_tolerance,
                                        &cli_flag_set,
                                        &cli_flag_lenient,
                                        &cli_flag_json,
                                        &cli_flag_verbose,
                                        &cli_flag_quiet,
                                        NULL};

static const cli_item examples[] = {
    {"skiagraph live scene.json", "opens the scene in a browser"},
    {"skiagraph live thorax/thorax.json --no-open --port 8765 --idle 3600",
     "on a machine of a cluster: then ssh -L 8765:localhost:8765 that machine"},
    {"skiagraph live thorax/thorax.json --fixed frontal.mha",
     "with a radiograph over the image, to which parts are registered"},
    {NULL, NULL}};

const cli_manual cli_manual_live = {.name = "live",
                                    .operands = "SCENE",
                                    .summary = "a page in which the scene is changed and its image follows",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_SCENE,
                                    .flags = flags,
                                    .examples = examples,
                                    .has_device = 1};
