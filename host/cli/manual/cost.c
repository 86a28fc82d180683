/* The manual of `cost`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag cost_output = {
    "-o", "FILE",
    "The file to write: .html (plots, pictures and advice in one page; its table is written beside it as .csv) or "
    ".csv. May be repeated.",
    NULL, CLI_NAMES_FILE};
static const cli_flag cost_quick = {"--quick", NULL, "Measures fewer settings, with fewer runs of each.",
                                    NULL, CLI_NAMES_NOTHING};

static const cli_flag cost_within = {
    "--within", "SECONDS",
    "Measures for about SECONDS, 1 to 86400 (default 60): every source of error coarsely, then the settings that say most. What "
    "does not fit is left out, and said.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag cost_frames = {
    "--frames", "N",
    "Times batches of N images, 1 to 4096 (default 1), and gives the time of one: what an image costs in a sequence or a scan.",
    NULL, CLI_NAMES_NOTHING};

static const cli_flag cost_sensitivity = {
    "--sensitivity", NULL,
    "Also prints how much the image changes when each part moves: the root mean square over all pixels of the derivative, as a "
    "share of the open beam for a mm along x, y and z and along the direction that changes it most. Takes three derivatives for "
    "each part, before SECONDS begin.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Computes the scene's image at many settings and compares each with the best that the device can give. "
    "Precision, tolerance and the tube's bins are compared with double precision and every energy, with the "
    "scene's own rays; source samples and supersampling with the largest number of them; repair of leaky meshes "
    "with the exact repair; triangles of spheres and cylinders (of 8 sectors or more) and of the generated thorax "
    "with the finest mesh; and in a scene with Breathing, relaxation and hysteresis with no relaxation.",
    "Prints first one sentence: what an image costs, how far it is off, which error is the largest, and what to change. Then a "
    "line for each source of error, and the settings for errors of 1e-2, 1e-3, 1e-4 and 1e-6 of the flat field. The page and "
    "the .csv have every setting. A price is what an image takes on an idle machine: on a CPU by processor time, which other processes "
    "hardly change, otherwise by the wall. It has its uncertainty. What one waits now stands beside it, where that is much more.",
    "Ctrl-C stops the measurement, and what is done is kept and written.",
    "--json prints {summary, sources, sensitivity, unrest, settings, references, points, advice, notes, ...}; settings and points have "
    "price: {ms, uncertainty, clock} and wall_now_ms; advice names points by their number.",
    NULL};

static const cli_flag *const flags[] = {
    &cost_output,       &cost_within,  &cost_frames,      &cost_quick,    &cost_sensitivity, &cli_flag_device,
    &cli_flag_strategy, &cli_flag_set, &cli_flag_lenient, &cli_flag_json, &cli_flag_verbose, &cli_flag_strict,
    &cli_flag_quiet,    NULL};

static const cli_item examples[] = {
    {"skiagraph cost scene.json -o cost.html", "writes cost.html and cost.csv and prints the result"},
    {"skiagraph cost scene.json --within 10", "measures for 10 seconds"},
    {"skiagraph cost scene.json --sensitivity --within 1", "which part's place shows most in the image"},
    {"skiagraph cost scene.json --frames 32", "the time of an image of a sequence"},
    {NULL, NULL}};

const cli_manual cli_manual_cost = {.name = "cost",
                                    .operands = "SCENE",
                                    .summary = "what accuracy costs: errors, times, and the setting to use",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_SCENE,
                                    .flags = flags,
                                    .examples = examples,
                                    .has_device = 1};
