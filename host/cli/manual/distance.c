/* The manual of `distance`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag distance_map = {"--map", "FILE.ply",
                                      "Writes A with the distance from B and its colour at each vertex.",
                                      NULL, CLI_NAMES_NOTHING};
static const cli_flag distance_output = {
    "-o", "FILE.png", "Draws both surfaces in the colours of their distances, from in front and from behind.",
    NULL, CLI_NAMES_FILE};
static const cli_flag distance_high = {
    "--high", "MM",
    "The distance at the bright end of the colours. If it is not given, the greatest one, rounded up.", NULL,
    CLI_NAMES_NOTHING};
/* In the order of enum skg_distance_sampling. */
static const cli_item samplings[] = {{"surface", "over the area of the triangles (the default)"},
                                     {"vertices", "at the vertices alone, all with the same weight"},
                                     {NULL, NULL}};
static const cli_flag distance_sampling = {"--sampling", NULL, "Where distances are computed.", samplings,
                                           CLI_NAMES_NOTHING};
static const cli_flag distance_spacing = {
    "--spacing", "MM",
    "The largest side of the triangles that a sample of the surface stands for. If it is not given, such that there are "
    "about 200,000.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Measures how far two surfaces are apart, as MESH and METRO define it. The distance of a point of A is that to the "
    "nearest point of B's triangles. Mean, root mean square and 95th percentile are taken over the area of A, the "
    "maximum is the one-sided Hausdorff distance. The way back, from B to A, differs; the larger maximum of the two is the "
    "Hausdorff distance.",
    "--json prints {mean_mm, rms_mm, p95_mm, max_mm, max_position_mm, samples, spacing_mm, back: {the same}, "
    "hausdorff_mm, sampling}.",
    NULL};

static const cli_flag *const flags[] = {
    &distance_map,       &distance_output, &distance_high,   &distance_sampling, &distance_spacing,
    &cli_flag_mesh_unit, &cli_flag_json,   &cli_flag_strict, &cli_flag_quiet,    NULL};

static const cli_item files[] = {{"FILE.ply", "A with the properties distance, red, green and blue"},
                                 {"FILE.png", "the maps of A and B"},
                                 {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph distance simulated.ply segmented.stl", "prints the distances between two surfaces"},
    {"skiagraph distance simulated.ply segmented.stl --map map.ply -o map.png --high 5",
     "writes maps whose colours end at 5 mm"},
    {NULL, NULL}};

const cli_manual cli_manual_distance = {.name = "distance",
                                        .operands = "A B",
                                        .summary = "how far two surfaces are apart: mean, maximum, maps",
                                        .text = text,
                                        .least = 2,
                                        .most = 2,
                                        .names = CLI_NAMES_FILE,
                                        .flags = flags,
                                        .files = files,
                                        .examples = examples};
