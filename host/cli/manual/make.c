/* The manual of `make`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag make_output = {"-o", "FILE", "The mesh to write, .ply or .stl. Required.", NULL,
                                     CLI_NAMES_FILE};
static const cli_flag make_box = {
    "--box", "X,Y,Z",
    "foam, fibres, gyroid: edges of the box, or one number for a cube; 20 if it is not given.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag make_radius = {"--radius", "MM",
                                     "Of the spheres of a foam (1), of the fibres (0.5) or of the star (20).",
                                     NULL, CLI_NAMES_NOTHING};
static const cli_flag make_fraction = {
    "--fraction", "F", "foam: the share of the box that the spheres fill, to 0.6; 0.1 if it is not given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag make_count = {"--count", "N",
                                    "The number of spheres, instead of --fraction, or of fibres (50).", NULL,
                                    CLI_NAMES_NOTHING};
static const cli_flag make_spread = {"--spread", "S",
                                     "foam: standard deviation of the radius as a share of it, 0 to 0.5.",
                                     NULL, CLI_NAMES_NOTHING};
static const cli_flag make_gap = {"--gap", "MM", "foam, fibres: the least distance between two.", NULL,
                                  CLI_NAMES_NOTHING};
static const cli_flag make_tilt = {"--tilt", "DEGREES", "fibres: the greatest angle to z, 0 to 60.", NULL,
                                   CLI_NAMES_NOTHING};
static const cli_flag make_seed = {"--seed", "N", "foam, fibres: another seed gives another body.", NULL,
                                   CLI_NAMES_NOTHING};
static const cli_flag make_segments = {"--segments", "N",
                                       "foam, fibres: corners around a sphere (12) or a fibre (16).", NULL,
                                       CLI_NAMES_NOTHING};
static const cli_flag make_period = {"--period", "MM", "gyroid: its period; 10 if it is not given.", NULL,
                                     CLI_NAMES_NOTHING};
static const cli_flag make_level = {
    "--level", "L",
    "gyroid: where |sin x cos y + sin y cos z + sin z cos x| is below this, there is matter; 0.3 if it is "
    "not given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag make_cells = {
    "--cells", "N",
    "gyroid: cells of the grid along a period, 4 to 256, and at least 9.43 over the level, since a sheet would have holes otherwise; that, and at least 24, if it is not given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag make_per_mm = {
    "--per-mm", "LIST",
    "lines: line pairs per mm of each group, separated by commas; 0.5,1,2 if it is not given.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag make_bars = {"--bars", "N", "lines: bars of each group; 4 if it is not given.", NULL,
                                   CLI_NAMES_NOTHING};
static const cli_flag make_length = {
    "--length", "MM", "lines: of a bar (20). steps: of the wedge along x (50).", NULL, CLI_NAMES_NOTHING};
static const cli_flag make_width = {"--width", "MM", "steps: of the wedge along y; 20 if it is not given.",
                                    NULL, CLI_NAMES_NOTHING};
static const cli_flag make_thickness = {"--thickness", "MM", "lines, star: along z; 1 if it is not given.",
                                        NULL, CLI_NAMES_NOTHING};
static const cli_flag make_heights = {
    "--heights", "LIST", "steps: heights of the steps in mm, rising; 5,10,15,20,25 if it is not given.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag make_inner = {
    "--inner", "MM", "star: radius where the spokes begin; 1 if it is not given.", NULL, CLI_NAMES_NOTHING};
static const cli_flag make_spokes = {"--spokes", "N", "star: number of spokes; 36 if it is not given.", NULL,
                                     CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Makes a body as one closed mesh, in mm, centred at the origin. KIND is one of foam (spheres in a box that do not "
    "overlap: pores, or grains), fibres (straight, through a box), gyroid (a sheet of it in a box), lines (groups of line "
    "pairs), star (a Siemens star) and steps (a wedge with steps of any height). The same flags give the same mesh.",
    "A foam is its pores: in a scene, give the matrix as a Cuboid and the pores as a sample inside it.",
    "--json prints {kind, triangles, vertices, components, volume_mm3, bounds, file}.", NULL};

static const cli_flag *const flags[] = {
    &make_output, &make_box,      &make_radius,     &make_fraction,  &make_count,
    &make_spread, &make_gap,      &make_tilt,       &make_seed,      &make_segments,
    &make_period, &make_level,    &make_cells,      &make_per_mm,    &make_bars,
    &make_length, &make_width,    &make_thickness,  &make_heights,   &make_inner,
    &make_spokes, &cli_flag_json, &cli_flag_strict, &cli_flag_quiet, NULL};

static const cli_item files[] = {{"FILE", "the mesh"}, {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph make foam --box 30 --radius 1.5 --fraction 0.25 --spread 0.1 -o foam.ply",
     "writes the pores of a foam"},
    {"skiagraph make lines --per-mm 1,2,5 --thickness 0.1 -o lines.ply", "writes three groups of line pairs"},
    {"skiagraph make steps --heights 1,2,5,10 -o wedge.stl", "writes a step wedge"},
    {NULL, NULL}};

const cli_manual cli_manual_make = {.name = "make",
                                    .operands = "KIND",
                                    .required = "-o FILE",
                                    .summary = "foam, fibres, gyroid, line pairs, star or steps as a mesh",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_NOTHING,
                                    .flags = flags,
                                    .files = files,
                                    .examples = examples};
