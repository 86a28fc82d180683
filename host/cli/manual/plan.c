/* The manual of `plan`: operands, flags, text, examples. */
#include "manual/manual.h"

static const char *const text[] = {
    "Plans a scene, computes one frame without writing it, and prints what was decided: strategy, tiles, planes, "
    "precision; every effect, on or off, with the reason and an estimate of its cost; the time of each stage; "
    "parts that overlap; what is not simulated; and what scatter would add, from some 8,000 histories, and whether the scene calls "
    "for it.",
    cli_text_meshes,
    "--json prints {effects, nodes, planes, strategy, tiles, bound, bound_precision, stages_ns, scatter, ...}: bound is "
    "the error that fewer energies and planes make, bound_precision that of rounding in the precision; "
    "both add up. Each node is [keV, photons per "
    "pixel]; the nodes can be given as the Beam of a scene with a Tolerance of 0.",
    NULL};

static const cli_flag *const flags[] = {&cli_flag_meshes_material,
                                        &cli_flag_meshes_kvp,
                                        &cli_flag_meshes_kev,
                                        &cli_flag_meshes_filter,
                                        &cli_flag_meshes_from,
                                        &cli_flag_mesh_unit,
                                        &cli_flag_device,
                                        &cli_flag_precision,
                                        &cli_flag_tolerance,
                                        &cli_flag_strategy,
                                        &cli_flag_set,
                                        &cli_flag_lenient,
                                        &cli_flag_json,
                                        &cli_flag_verbose,
                                        &cli_flag_strict,
                                        &cli_flag_quiet,
                                        NULL};

static const cli_item examples[] = {
    {"skiagraph plan scene.json", "prints the effects that the scene calls for"}, {NULL, NULL}};

const cli_manual cli_manual_plan = {.name = "plan",
                                    .operands = "SCENE|MESH...",
                                    .summary = "what would be simulated, and why",
                                    .text = text,
                                    .least = 1,
                                    .most = -1,
                                    .names = CLI_NAMES_FILE,
                                    .flags = flags,
                                    .examples = examples,
                                    .has_device = 1};
