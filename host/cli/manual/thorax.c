/* The manual of `thorax`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag thorax_output = {
    "-o", "DIR", "The folder to write to. It is made if it does not exist.", NULL, CLI_NAMES_FOLDER};
static const cli_flag thorax_triangles = {
    "--triangles", "N",
    "The approximate number of triangles of all meshes, 10000 to 20000000. The default is 42000.", NULL,
    CLI_NAMES_NOTHING};

static const cli_flag thorax_simple = {
    "--simple", NULL,
    "Generates the simple thorax: 67 parts in a body of fat, without muscle, great vessels, vessels of the lungs, "
    "marrow, shoulder blades and bowel.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Generates a thorax at end-expiration: fat, muscle, spine, ribs with marrow, shoulder blades, lungs with their "
    "vessels, heart, great vessels, diaphragm, liver, bile ducts with contrast, bowel, a Chiba needle and more. "
    "Each part is one closed mesh.",
    "The scene file names tissues, the beam of a tube, and a percutaneous cholangiography for `breathe`.",
    "--json prints {parts, triangles, folder}.", NULL};

static const cli_flag *const flags[] = {&thorax_output,
                                        &thorax_triangles,
                                        &thorax_simple,
                                        &cli_flag_json,
                                        &cli_flag_strict,
                                        &cli_flag_quiet,
                                        NULL};

static const cli_item files[] = {
    {"DIR/thorax.json", "the scene file"}, {"DIR/*.ply", "a mesh for each part"}, {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph thorax -o thorax", "writes the meshes and thorax/thorax.json"},
    {"skiagraph thorax --simple -o simple", "writes the simple thorax"},
    {"skiagraph thorax -o fine --triangles 1000000", "writes finer meshes"},
    {NULL, NULL}};

const cli_manual cli_manual_thorax = {.name = "thorax",
                                      .operands = "",
                                      .required = "-o DIR",
                                      .summary = "meshes and scene file of a generated thorax",
                                      .text = text,
                                      .flags = flags,
                                      .files = files,
                                      .examples = examples};
