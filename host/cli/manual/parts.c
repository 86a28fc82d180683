/* The manual of `parts`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag parts_output = {"-o", "FILE.csv", "The table as a file, a line a part.", NULL,
                                      CLI_NAMES_FILE};

static const char *const text[] = {
    "Prints a table of the parts of a scene, for a report: material, density, volume, mass, mean path and share of the "
    "attenuation. The volume is that of the part's mesh, times its pose, without the parts that lie inside it; overlaps "
    "that a Priority or Clip decides are not taken off. A part whose mesh is not closed has no volume and no mass.",
    "The mean path is the mean net length of the rays that meet the part. The share is the part's of the sum, over all "
    "pixels and parts, of attenuation coefficient times length, at the mean energy of the beam.",
    cli_text_meshes,
    "--json prints {energy_keV, parts: [{label, material, density_g_cm3, volume_mm3, mass_g, mean_path_mm, share}]}; a "
    "value that is not known is null.",
    NULL};

static const cli_flag *const flags[] = {&parts_output,           &cli_flag_meshes_material,
                                        &cli_flag_meshes_kvp,    &cli_flag_meshes_kev,
                                        &cli_flag_meshes_filter, &cli_flag_meshes_from,
                                        &cli_flag_mesh_unit,     &cli_flag_device,
                                        &cli_flag_strategy,      &cli_flag_set,
                                        &cli_flag_lenient,       &cli_flag_json,
                                        &cli_flag_verbose,       &cli_flag_strict,
                                        &cli_flag_quiet,         NULL};

static const cli_item files[] = {{"FILE.csv", "the table"}, {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph parts scene.json", "prints the table"},
    {"skiagraph parts scene.json -o parts.csv", "writes it for a spreadsheet, too"},
    {NULL, NULL}};

const cli_manual cli_manual_parts = {.name = "parts",
                                     .operands = "SCENE|MESH...",
                                     .summary =
                                         "a table of the parts: density, volume, mass, mean path, share",
                                     .text = text,
                                     .least = 1,
                                     .most = -1,
                                     .names = CLI_NAMES_FILE,
                                     .flags = flags,
                                     .files = files,
                                     .examples = examples,
                                     .has_device = 1};
