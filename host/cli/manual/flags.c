/* Flags that several verbs take. */
#include "manual/manual.h"

const cli_flag cli_flag_help = {"--help", NULL, "Prints this text.", NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_device = {
    "--device", "NAME",
    "The OpenCL device: cpu, gpu, PLATFORM:DEVICE by numbers, or part of a device's name. \"cpu threads=4\" "
    "also limits the number of threads. \"driver=PATH\" opens the library of an OpenCL driver that is not "
    "installed, and chooses among its devices; a path with blanks stands in double quotes. The default is the environment variable SKG_DEVICE, then the best "
    "device that there is.",
    NULL, CLI_NAMES_NOTHING};

/* In the order of SKG_PRECISION_. */
static const cli_item precisions[] = {
    {"single", "32-bit floating point, exact sums of 32-bit integers"},
    {"double", "64-bit floating point, for devices that have it"},
    {"half", "the 16-bit buffers of Vidal and Villard 2016, for comparison"},
    {NULL, NULL}};
const cli_flag cli_flag_precision = {
    "--precision", NULL,
    "The precision of path lengths and image. The default is the scene's Precision, otherwise single.",
    precisions, CLI_NAMES_NOTHING};

const cli_flag cli_flag_tolerance = {
    "--tolerance", "ERROR",
    "The relative error that is allowed to the compressed spectrum, from 0 to below 1. The default is the "
    "scene's Tolerance.",
    NULL, CLI_NAMES_NOTHING};

/* In the order of SKG_STRATEGY_. */
static const cli_item strategies[] = {
    {"auto", "chosen by the plan (the default)"},
    {"copies", "a private copy of the detector for each work-group"},
    {"tiles", "one tile of the detector at a time, with the triangles sorted into tiles"},
    {"atomics", "atomic additions to one detector"},
    {NULL, NULL}};
const cli_flag cli_flag_strategy = {
    "--strategy", NULL, "How the hits of triangles are summed. Every strategy gives the same bits.",
    strategies, CLI_NAMES_NOTHING};

const cli_flag cli_flag_set = {
    "--set", "KEY=VALUE",
    "Changes a key of the scene file before it is read: Detector.NumberOfPixels=[64,64], "
    "Samples.liver.Type=inner. KEY=null deletes the key. May be repeated. `skiagraph help keys` lists the keys.",
    NULL, CLI_NAMES_KEY};

const cli_flag cli_flag_lenient = {
    "--lenient", NULL,
    "Reads a scene file although it has unknown keys, fractions of a mixture that do not sum to 1, or a Size that "
    "contradicts Spacing: these are warnings.",
    NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_strict = {
    "--strict", NULL,
    "Makes an error of warnings: the exit status is 1 if there was one, also with --quiet. Outputs are written all the same.",
    NULL, CLI_NAMES_NOTHING};
const cli_flag cli_flag_quiet = {"--quiet", NULL, "Prints errors only.", NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_verbose = {
    "--verbose", NULL,
    "Says on standard error what was loaded, chosen and compiled: device, parts, beam, and every effect that is on.",
    NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_json = {
    "--json", NULL,
    "Prints one JSON object on standard output; after a failure {error: {status, message, where}}.", NULL,
    CLI_NAMES_NOTHING};

const cli_flag cli_flag_output = {
    "-o", "FILE",
    "The file to write; its extension, .png, .tif, .mha or .dcm, is its format; - writes a .mha to standard output. May be repeated.",
    NULL, CLI_NAMES_FILE};

const cli_flag cli_flag_plot = {
    "-o", "FILE", "The file to write: .csv (the numbers), .png or .svg (a plot). May be repeated.", NULL,
    CLI_NAMES_FILE};

const cli_flag cli_flag_repeat = {
    "--repeat", "N",
    "Computes N more frames and prints the minimum and the median of their times, of the frame and of each "
    "stage.",
    NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_range = {
    "--range", "LOW:HIGH",
    "The values that a .png shows as black and as white. The default for an image are the percentiles 0.5 and 99.5 of "
    "its pixels, for path lengths the least and the largest.",
    NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_meshes_material = {
    "--material", "NAME",
    "The operands are meshes of this material: an element, a compound or a tissue, as in `skiagraph material NAME`. "
    "Given several times, each mesh in order has its own.",
    NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_meshes_kvp = {
    "--kvp", "KV", "With --material: the voltage of the tube, 10 to 450 kV.", NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_meshes_kev = {"--kev", "E", "With --material: the one energy of the beam, in keV.",
                                      NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_meshes_filter = {
    "--filter", "MATERIAL:MM",
    "With --kvp: a filter of the beam with its thickness in mm, or in another unit that follows: Al:2.5, Cu:100um. "
    "May be repeated. The default is 2.5 mm of aluminium.",
    NULL, CLI_NAMES_NOTHING};

const cli_flag cli_flag_meshes_from = {
    "--from", "front|side|top|ANGLES|X,Y,Z",
    "With --material: the side on which the source stands: front is -y (the default), side is +x, top is +z; ANGLES of a C-arm such as "
    "'LAO 30 CRAN 20', AP, PA or LAT, where x is the body's left, y its back and z its head; or the "
    "direction from the meshes to the source. The picture is as seen from there, with +z up; from the top, with +y up.",
    NULL, CLI_NAMES_NOTHING};

const char cli_text_meshes[] =
    "With --material the operands are meshes instead of a scene: the source stands 1 m from their centre (farther if "
    "they are large), and a detector of up to 512 x 512 pixels is fitted behind them. --set changes that scene as well: "
    "--set Detector.NumberOfPixels=[2000,1000].";
