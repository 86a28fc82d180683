/* The manual of `register`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag register_image = {
    "--image", "FILE[@K]",
    "A radiograph: .mha, .mhd, .tif, .png or .dcm. K is the projection of the scene's Scan that it was taken from, and the page of a file that "
    "has several; without it the view is that of the scene's Source and Detector. May be given several times.",
    NULL, CLI_NAMES_FILE};
static const cli_flag register_part = {
    "--part", "LABELS",
    "The body: labels of parts, separated by commas, in which * stands for any text; all parts that fit move as one. Given again, "
    "another body, which is registered when the one before has found its place.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag register_output = {
    "-o", "FILE", "The scene with the parts, or the views, where they were found (.json).", NULL,
    CLI_NAMES_FILE};
static const cli_flag register_report = {
    "--report", "FILE",
    "A page with the overlays, what is left, the path of the loss and the table of freedoms (.html).", NULL,
    CLI_NAMES_OUTPUT};
/* The values of skg_registration_options.free, in this order. */
static const cli_item frees[] = {{"pose", "the parts (the default)"},
                                 {"source", "the source, of each view"},
                                 {"detector", "the detector, of each view"},
                                 {"geometry", "both: nine numbers of each view"},
                                 {NULL, NULL}};
static const cli_flag register_free = {
    "--free", NULL,
    "What is found. Source and detector need parts whose place is known, such as a phantom of balls.", frees,
    CLI_NAMES_NOTHING};
/* In the order of SKG_REGISTRATION_LOSS_. */
static const cli_item losses[] = {
    {"lsq", "squares of the difference of attenuations, less what polynomials take (the default)"},
    {"ncc", "correlation of attenuations"},
    {"gradient-ncc", "correlation of their differences from pixel to pixel"},
    {NULL, NULL}};
static const cli_flag register_loss = {"--loss", NULL, "What is minimized.", losses, CLI_NAMES_NOTHING};
static const cli_flag register_polish = {"--polish", NULL, "Ends the search with --loss gradient-ncc.", NULL,
                                         CLI_NAMES_NOTHING};
static const cli_flag register_start = {
    "--start", "TX,TY,TZ,RX,RY,RZ",
    "Where the search starts: a twist of the first body in mm and radians, in the axes of the world and about its origin, in addition to "
    "the poses of the scene.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag register_mask = {
    "--mask", "FILE",
    "An image that is 0 where pixels do not count. Given once, it holds for all radiographs; otherwise one for each.",
    NULL, CLI_NAMES_FILE};
/* In the order of register_quantities in host/cli/register/radiographs.c. */
static const cli_item quantities[] = {{"intensity", "in any unit, such as grey values; see --flat"},
                                      {"transmission", "I/I0"},
                                      {"attenuation", "-ln(I/I0)"},
                                      {NULL, NULL}};
const cli_flag cli_flag_register_quantity = {
    "--quantity", NULL,
    "What the radiographs hold. The default is what their files say if skiagraph wrote them, otherwise intensity.",
    quantities, CLI_NAMES_NOTHING};
const cli_flag cli_flag_register_flat = {
    "--flat", "NUMBER|FILE",
    "The intensity without parts, as a number or an image. Given once, it holds for all radiographs; otherwise one for each. Without it, "
    "it is the largest intensity of the radiograph.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag register_restarts = {
    "--restarts", "N",
    "Ranks N further starts on small images, and follows the best three; 0 if it is not given.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag register_seed = {
    "--seed", "N", "Another seed gives other starts; 1 if it is not given.", NULL, CLI_NAMES_NOTHING};
static const cli_flag register_spread = {
    "--spread", "MM:DEGREES", "How far from the first start others are at most; 20:15 if it is not given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag register_margin = {
    "--margin", "MM",
    "Pixels count that are at most this far from the body's shadow, measured at the body; 25 if it is not given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag register_need = {"--need", "MM",
                                       "How well each direction has to be known; 1 if it is not given.", NULL,
                                       CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Moves parts of a scene until their rendered attenuation agrees with radiographs, by the derivatives of the images. What does not move is "
    "rendered once. What the scene lacks is fitted with the pose: polynomials over the image that add to the attenuation (tissue, gain) and "
    "to the transmission (scatter), and gains of kinds of tissue and of the body's contrast (density, energy).",
    "The verdict is one of: agrees, agrees but for structure, not determined (with the direction), failed. sigma is the standard deviation "
    "from noise alone, and no error; sigma_structure takes what is left in the images for noise.",
    "Ctrl-C ends the search, and the best pose so far is written.",
    "--json prints {status, verdict, parts: [{label, twist, sigma, sigma_structure, determined, middle, shift_mm, turn_deg, status, "
    "verdict, loss, directions: [{name, sigma_mm, sigma_structure_mm, determined}]}], views: [{projection, source, centre, column_step, "
    "row_step}], loss, loss_start, residual, noise, explained, agreement, energy_kev, worst: {view, row, column}, evaluations, jacobians, seconds}.",
    NULL};

static const cli_flag *const flags[] = {&register_image,         &register_part,
                                        &register_output,        &register_report,
                                        &register_free,          &register_loss,
                                        &register_polish,        &register_start,
                                        &register_mask,          &cli_flag_register_quantity,
                                        &cli_flag_register_flat, &register_restarts,
                                        &register_seed,          &register_spread,
                                        &register_margin,        &register_need,
                                        &cli_flag_device,        &cli_flag_precision,
                                        &cli_flag_strategy,      &cli_flag_set,
                                        &cli_flag_lenient,       &cli_flag_json,
                                        &cli_flag_strict,        &cli_flag_quiet,
                                        &cli_flag_verbose,       NULL};

static const cli_item files[] = {
    {"FILE.json", "a scene that every verb takes"},
    {"FILE.html", "overlays, what is left, the path of the loss, the table of freedoms"},
    {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph register thorax.json --image frontal.mha@0 --image lateral.mha@9 --part spine -o registered.json --report report.html",
     "finds the spine in two projections of the scene's Scan"},
    {"skiagraph register thorax.json --image frontal.mha --part 'vertebra_*' --part vertebra_t07 --restarts 20 -o registered.json",
     "finds the spine as one body, and then one of its vertebrae"},
    {"skiagraph register phantom.json --image shot.mha --free geometry -o calibrated.json",
     "finds source and detector from a phantom whose place is known"},
    {NULL, NULL}};

const cli_manual cli_manual_register = {.name = "register",
                                        .operands = "SCENE",
                                        .required = "--image FILE[@K] --part LABELS -o FILE.json",
                                        .summary = "finds parts, or source and detector, from radiographs",
                                        .text = text,
                                        .least = 1,
                                        .most = 1,
                                        .names = CLI_NAMES_SCENE,
                                        .flags = flags,
                                        .files = files,
                                        .examples = examples,
                                        .check = "the parts are not where they show in the radiographs",
                                        .has_device = 1};
