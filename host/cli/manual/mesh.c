#include "manual/manual.h"

/* In the order of the lengths in verbs/mesh.c. */
static const cli_item units[] = {{"um", "micrometre"}, {"mm", "millimetre (the default)"},
                                 {"cm", "centimetre"}, {"dm", "decimetre"},
                                 {"m", "metre"},       {NULL, NULL}};
const cli_flag cli_flag_mesh_unit = {"--unit", "UNIT", "The unit of the numbers in the files.", units,
                                     CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Reads meshes (STL, PLY, OBJ and every other format that Assimp reads) and reports whether each is closed. "
    "Path lengths through a closed mesh are exact on every ray; a mesh that is not closed is leaky. A closed mesh "
    "whose triangles all face inward is turned outward.",
    "A file that cannot be read is reported, and the files after it are read all the same.",
    "--json prints {files: [{file, closed, triangles, vertices, open_edges, volume_mm3, area_mm2, bounds, ...}]}.",
    NULL};

static const cli_flag *const flags[] = {&cli_flag_mesh_unit, &cli_flag_json, &cli_flag_quiet, NULL};

static const cli_item examples[] = {
    {"skiagraph mesh liver.stl lungs.ply", "reports the health of two meshes"},
    {"skiagraph mesh part.obj --unit m", "reads positions in metres"},
    {NULL, NULL}};

const cli_manual cli_manual_mesh = {.name = "mesh",
                                    .operands = "FILE...",
                                    .summary = "health of meshes: closed? outward? volume, size",
                                    .text = text,
                                    .least = 1,
                                    .most = -1,
                                    .names = CLI_NAMES_FILE,
                                    .flags = flags,
                                    .examples = examples,
                                    .check = "a mesh is leaky"};
