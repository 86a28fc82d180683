/* The manual of `schema`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag schema_output = {"-o", "FILE.json", "The schema as a file.", NULL, CLI_NAMES_FILE};

static const cli_flag schema_paths = {
    "--paths", NULL, "Prints the keys as --set takes them instead, a line each: Detector.NumberOfPixels=.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Prints the JSON Schema (draft 2020-12) of scene files. It is made of the tables by which they are read: what it refuses, reading refuses. "
    "What depends on several keys, or on other files, only reading tells (skiagraph plan SCENE).",
    "A scene names it by \"$schema\": \"scene.schema.json\", a file beside it, which an editor that knows JSON Schema (Visual Studio Code, "
    "JetBrains, Neovim with a language server) uses to complete keys, explain them and mark errors. The same file is installed as "
    "share/skiagraph/scene.schema.json. `skiagraph help keys` lists the keys as text.",
    NULL};

static const cli_flag *const flags[] = {&schema_output, &schema_paths, &cli_flag_quiet, NULL};

static const cli_item files[] = {{"FILE.json", "the schema"}, {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph schema", "prints the schema"},
    {"skiagraph schema -o scene.schema.json", "puts it beside scenes that name it by \"$schema\""},
    {NULL, NULL}};

const cli_manual cli_manual_schema = {.name = "schema",
                                      .operands = "",
                                      .summary = "the JSON Schema of scene files, for editors and checks",
                                      .text = text,
                                      .flags = flags,
                                      .files = files,
                                      .examples = examples};
