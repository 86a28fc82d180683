/* The manual of `lbuffer`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag lbuffer_part = {
    "--part", "LABEL",
    "The label of the sample whose path lengths are computed; of one mesh with --material it may be left out.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag lbuffer_surface = {
    "--surface", NULL,
    "Writes the path lengths inside the part's mesh, the parts inside it included. The default is the net length, "
    "without the parts inside it.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Computes, for the ray of each pixel, the length in mm inside one part, and writes it to the file of every -o.",
    "A .png shows lengths from black (the least) to white (the largest), or over --range. A .tif or .mha holds "
    "floats, or doubles with --precision double.",
    cli_text_meshes,
    "--json prints {frame_ms, first_ms, plan_ms, stages, range, files, plan}; times are in ms, and range has the least and "
    "the largest length.",
    NULL};

static const cli_flag *const flags[] = {
    &lbuffer_part,         &cli_flag_output,     &lbuffer_surface,
    &cli_flag_range,       &cli_flag_repeat,     &cli_flag_meshes_material,
    &cli_flag_meshes_kvp,  &cli_flag_meshes_kev, &cli_flag_meshes_filter,
    &cli_flag_meshes_from, &cli_flag_mesh_unit,  &cli_flag_device,
    &cli_flag_precision,   &cli_flag_strategy,   &cli_flag_set,
    &cli_flag_lenient,     &cli_flag_json,       &cli_flag_verbose,
    &cli_flag_strict,      &cli_flag_quiet,      NULL};

static const cli_item examples[] = {
    {"skiagraph lbuffer scene.json --part liver -o liver.mha", "writes the path lengths through the liver"},
    {"skiagraph lbuffer bunny.stl --material Al --from top -o bunny.tif",
     "writes those through a mesh, from above"},
    {NULL, NULL}};

const cli_manual cli_manual_lbuffer = {.name = "lbuffer",
                                       .operands = "SCENE|MESH...",
                                       .required = "--part LABEL",
                                       .summary = "path lengths through one part (the L-buffer)",
                                       .text = text,
                                       .least = 1,
                                       .most = -1,
                                       .names = CLI_NAMES_FILE,
                                       .flags = flags,
                                       .examples = examples,
                                       .has_device = 1};
