/* The manual of `fit`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag fit_target = {
    "--target", "PART=FILE",
    "A surface that this part of the scene has to reach, as it was segmented at the phase of --phase. May be given several "
    "times.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag fit_phase = {
    "--phase", "P",
    "The phase of the targets that follow, and of those before the first --phase: 0 to below 1, from end-inspiration.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag fit_output = {
    "-o", "FILE",
    "The scene with the fitted parameters (.json); further ones for a page with maps (.html), a table (.csv) and a picture "
    "of the errors (.png).",
    NULL, CLI_NAMES_FILE};
static const cli_flag fit_parameters = {
    "--parameters", "NAMES",
    "What is fitted, separated by commas: tendon-x, tendon-y, tendon-z, dome-left, dome-right, dome-back, muscle-length, "
    "rib-angle, rib-fall, liver-follows, liver-held, or the groups tendon, domes, muscle, ribs and follow; tissues "
    "(diaphragm-alpha-min, -alpha-max, -beta, liver-alpha-min, ...) or the groups diaphragm and liver. With the coupling "
    "\"Paper\" also plane-azimuth, plane-elevation, plane-offset, diaphragm-ribs, diaphragm-liver, or the groups plane and "
    "links, instead of those from dome-left to liver-held. If it is not given: what Breathing.Fit of the scene says, or all but tissues; with the coupling "
    "\"Paper\" all.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag fit_bounds = {"--bounds", "NAME=LOW:HIGH",
                                    "The range of a parameter. May be given several times.", NULL,
                                    CLI_NAMES_NOTHING};
static const cli_flag fit_evaluations = {"--evaluations", "N",
                                         "Poses the body at most N times; 4000 if it is not given.", NULL,
                                         CLI_NAMES_NOTHING};
static const cli_flag fit_seed = {"--seed", "N", "Another seed gives another search; 1 if it is not given.",
                                  NULL, CLI_NAMES_NOTHING};
/* In the order of enum skg_fit_method. */
static const cli_item methods[] = {
    {"cma", "CMA-ES (the default)"}, {"de", "differential evolution"}, {NULL, NULL}};
static const cli_flag fit_method = {"--method", NULL, "How parameters are searched.", methods,
                                    CLI_NAMES_NOTHING};
static const cli_flag fit_checkpoint = {
    "--checkpoint", "FILE",
    "Keeps the state of the search here after each generation, and continues from it if the file exists.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Finds the parameters of breathing with which the organs of a scene come nearest to surfaces that were segmented from a "
    "patient. What is minimized is the root mean square, over all targets, of the distance from the organ's vertices to the "
    "target. Parts that are no target move along.",
    "For each parameter, sigma says how far it may go, the others following, before the errors grow by what is left of them "
    "(at least 0.1 mm). If sigma is more than a fifth of the range, the targets do not determine the parameter.",
    "The same scene, targets, flags and seed give the same result with any number of threads. No device is used.",
    "--json prints {evaluations, seconds, generations, restarts, error_mm, parameters: [{name, value, unit, sigma, start, low, "
    "high, determined}], covariance, parts: [{label, phase, motion_mm, before: {mean_mm, rms_mm, max_mm}, after: {the "
    "same}}]}.",
    NULL};

static const cli_flag *const flags[] = {
    &fit_target,     &fit_phase,          &fit_output,     &fit_parameters,
    &fit_bounds,     &fit_evaluations,    &fit_seed,       &fit_method,
    &fit_checkpoint, &cli_flag_mesh_unit, &cli_flag_set,   &cli_flag_lenient,
    &cli_flag_json,  &cli_flag_strict,    &cli_flag_quiet, NULL};

static const cli_item files[] = {{"FILE.json", "a scene that every verb takes"},
                                 {"FILE.html", "tables, errors and maps on one page"},
                                 {"FILE.csv", "a line for each target"},
                                 {"FILE.png", "errors before and after, as bars"},
                                 {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph fit thorax.json --target liver=liver_in.stl --target diaphragm=diaphragm_in.stl --phase 0 -o fitted.json",
     "fits all parameters to two surfaces at end-inspiration"},
    {"skiagraph fit thorax.json --phase 0 --target liver=a.stl --phase 0.25 --target liver=b.stl --parameters tendon,liver "
     "-o fitted.json -o report.html",
     "fits six parameters to two phases"},
    {NULL, NULL}};

const cli_manual cli_manual_fit = {.name = "fit",
                                   .operands = "SCENE",
                                   .required = "--target PART=FILE --phase P -o FILE.json",
                                   .summary = "fits a body to surfaces of a patient",
                                   .text = text,
                                   .least = 1,
                                   .most = 1,
                                   .names = CLI_NAMES_SCENE,
                                   .flags = flags,
                                   .files = files,
                                   .examples = examples};
