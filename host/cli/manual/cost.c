#include "manual/manual.h"

const cli_flag cli_flag_cost_output = {
    "-o", "FILE",
    "The file to write: .html (plots, pictures and advice in one page; its table is written beside it as .csv) or "
    ".csv. May be repeated.",
    NULL, CLI_NAMES_FILE};
const cli_flag cli_flag_cost_quick = {"--quick", NULL, "Measures fewer settings, with fewer runs of each.",
                                      NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Computes the scene's image at many settings and compares each with the best that the device can give. "
    "Precision, tolerance and the tube's bins are compared with double precision and every energy, with the "
    "scene's own rays; source samples and supersampling with the largest number of them; repair of leaky meshes "
    "with the exact repair; triangles of spheres and cylinders (of 8 sectors or more) and of the generated thorax "
    "with the finest mesh; and in a scene with Breathing, relaxation and hysteresis with no relaxation.",
    "Prints for each setting the minimum and the median time, the largest and the root mean square error, as "
    "fractions of the flat field and of the pixel, and errors of path lengths and displacements in mm. For errors "
    "of 1e-2, 1e-3, 1e-4 and 1e-6 it prints the fastest command that reaches them. Times are meaningful only on an "
    "idle machine.",
    "--json prints {references, points, advice, notes, ...}; advice names points by their number.", NULL};

static const cli_flag *const flags[] = {
    &cli_flag_cost_output, &cli_flag_cost_quick, &cli_flag_device,  &cli_flag_strategy, &cli_flag_set,
    &cli_flag_lenient,     &cli_flag_json,       &cli_flag_verbose, &cli_flag_quiet,    NULL};

static const cli_item examples[] = {
    {"skiagraph cost scene.json -o cost.html", "writes cost.html and cost.csv and prints the table"},
    {"skiagraph cost scene.json --quick", "prints a shorter table in a fraction of the time"},
    {NULL, NULL}};

const cli_manual cli_manual_cost = {.name = "cost",
                                    .operands = "SCENE",
                                    .summary = "error against time for every dial, and the setting to use",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_SCENE,
                                    .flags = flags,
                                    .examples = examples,
                                    .has_device = 1};
