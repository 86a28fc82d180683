#include "manual/manual.h"

const cli_flag cli_flag_devices_warm = {
    "--warm", "SCENE",
    "Instead of listing devices, compiles the kernels that a scene needs by rendering it once; of a folder, those of all its "
    "scene files. Jobs that follow find the kernels in the driver's cache. May be repeated.",
    NULL, CLI_NAMES_SCENE};

static const char *const text[] = {
    "Lists every OpenCL device. The device that is chosen has a star: the one of --device, otherwise that of the "
    "environment variable SKG_DEVICE, otherwise by the rule \"GPUs before CPUs, more compute units first\".",
    "Then lists the environment variables that change how devices work.",
    "--json prints {devices: [{device, name, platform, kind, chosen, ...}], environment, affinity}; with --warm, {device, "
    "warm: [{scene, seconds}]}.",
    NULL};

static const cli_flag *const flags[] = {&cli_flag_device, &cli_flag_devices_warm, &cli_flag_json,
                                        &cli_flag_quiet, NULL};

static const cli_item examples[] = {
    {"skiagraph devices", "lists the devices"},
    {"skiagraph devices --device cpu", "shows which device \"cpu\" names"},
    {"skiagraph devices --warm scenes/", "compiles what the scenes of a folder need, before a batch of jobs"},
    {NULL, NULL}};

const cli_manual cli_manual_devices = {.name = "devices",
                                       .operands = "",
                                       .summary = "what OpenCL offers, and what would be chosen",
                                       .text = text,
                                       .flags = flags,
                                       .examples = examples,
                                       .has_device = 1};
