/* The manual of `mesh`: operands, flags, text, examples. */
#include "manual/manual.h"

/* In the order of the lengths in common/unit.c. */
static const cli_item units[] = {{"nm", "nanometre"},  {"um", "micrometre"}, {"mm", "millimetre"},
                                 {"cm", "centimetre"}, {"dm", "decimetre"},  {"m", "metre"},
                                 {"in", "inch"},       {"inch", "the same"}, {"ft", "foot"},
                                 {NULL, NULL}};
const cli_flag cli_flag_mesh_unit = {
    "--unit", "UNIT",
    "The unit of the numbers in the files. Without it, the one that a file or its format names "
    "(3MF, AMF, COLLADA, X3D, glTF, FBX, MetaImage, NRRD, NIfTI), otherwise mm.",
    units, CLI_NAMES_NOTHING};

static const cli_flag mesh_fix = {"--fix", NULL,
                                  "Turns inverted components and writes the mesh, in mm, to the file of -o.",
                                  NULL, CLI_NAMES_NOTHING};
static const cli_flag mesh_output = {"-o", "FILE", "With --fix: the file to write, .ply or .stl.", NULL,
                                     CLI_NAMES_FILE};

static const cli_flag mesh_groups = {
    "--groups", NULL,
    "Lists the groups and objects of the files: of OBJ, 3MF, and the nodes of glTF and others.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag mesh_group = {"--group", "NAME", "Reads only the group or object of this name.", NULL,
                                    CLI_NAMES_NOTHING};
static const cli_flag mesh_split = {
    "--split", "DIR",
    "Writes each group or object of one file as a .ply in mm to this folder, and with --scene a scene of them.",
    NULL, CLI_NAMES_FOLDER};
static const cli_flag mesh_scene = {
    "--scene", "FILE",
    "With --split: the scene file to write, a part for each group, all of water until you say otherwise.",
    NULL, CLI_NAMES_OUTPUT};

static const char *const text[] = {
    "Reads meshes (STL, PLY, OBJ and every other format that Assimp reads) and reports whether each is closed. "
    "Path lengths through a closed mesh are exact on every ray; a mesh that is not closed is leaky. A closed mesh "
    "whose triangles all face inward is turned outward.",
    "Triangles that are wound otherwise than their neighbours are turned, and counted: such a mesh is wound inconsistently, not "
    "open. Edges of more than two triangles and one-sided surfaces (a Moebius strip) stay what they are. With --strict a mesh "
    "that had to be turned makes the status 1.",
    "A component inside another is a cavity and has to face inward; one in the open has to face outward. Components "
    "whose orientation contradicts their place are inverted: they make lengths negative or count them twice. A cavity "
    "that leaves its solid cannot be turned; it has to be mended where the mesh was made.",
    "The unit of the numbers is said, and where it comes from: the file, --unit, or nobody (mm).",
    "Components that overlap, and triangles that are listed twice (duplicates), count twice: their status is 1. \"Repair\": "
    "\"union\" in a scene counts them once.",
    "A volume of cells (.mha, .mhd, .nrrd, .nhdr, .nii, .nii.gz, or a folder of DICOM slices) is described: cells, spacing, the world's axes that its axes follow, bounds, range, and if values are "
    "negative, as Hounsfield numbers are, the shares of tissues by Schneider's table and the mass.",
    "A file that cannot be read is reported, and the files after it are read all the same.",
    "--json prints {files: [{file, unit: {name, mm, from}, closed, triangles, vertices, open_edges, volume_mm3, area_mm2, bounds, "
    "turned, duplicates, overlapping_components, inverted_components, leaving_cavities, ...}]}.",
    NULL};

static const cli_flag *const flags[] = {&cli_flag_mesh_unit, &mesh_groups,    &mesh_group,  &mesh_split,
                                        &mesh_scene,         &mesh_fix,       &mesh_output, &cli_flag_json,
                                        &cli_flag_strict,    &cli_flag_quiet, NULL};

static const cli_item examples[] = {
    {"skiagraph mesh liver.stl lungs.ply", "reports the health of two meshes"},
    {"skiagraph mesh ct.mha", "says what a volume is, and where"},
    {"skiagraph mesh part.obj --unit m", "reads positions in metres"},
    {"skiagraph mesh body.obj --split parts --scene body.json", "makes a scene of the groups of a file"},
    {"skiagraph mesh phantom.stl --fix -o turned.ply", "turns inverted components"},
    {NULL, NULL}};

const cli_manual cli_manual_mesh = {
    .name = "mesh",
    .operands = "FILE...",
    .summary = "health of meshes: closed? outward? volume, size",
    .text = text,
    .least = 1,
    .most = -1,
    .names = CLI_NAMES_FILE,
    .flags = flags,
    .examples = examples,
    .check = "a mesh is leaky, or has inverted or overlapping components or duplicate triangles"};
