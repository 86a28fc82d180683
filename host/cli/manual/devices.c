/* The manual of `devices`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag devices_warm = {
    "--warm", "SCENE",
    "Instead of listing devices, compiles the kernels that a scene needs by rendering it once; of a folder, those of all its "
    "scene files. Jobs that follow find the kernels in the driver's cache. May be repeated.",
    NULL, CLI_NAMES_SCENE};

static const cli_flag devices_test = {
    "--test", NULL,
    "Instead of listing devices, tests every device with all kernels, in processes of their own and for 30 s a test at most, "
    "and prints a table.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Lists every OpenCL device. The device that is chosen has a star: the one of --device, otherwise that of the "
    "environment variable SKG_DEVICE, otherwise by the rule \"GPUs before CPUs, then the faster one\", or the one with more compute units if they were not "
    "measured.",
    "A driver that Skiagraph does not know (any but PoCL and those of Intel, NVIDIA and AMD) may end, crash or block the process that "
    "calls it. Its devices are tested in processes of their own, for 30 s at most; the list says how a test failed, and "
    "quotes the last line that the driver printed. One that passes may be chosen from then on, as long as SKG_CACHE_DIR keeps the "
    "verdict. If --device or SKG_DEVICE names one that was not tested, every verb tests it so before it opens it. If a driver ends the "
    "process that lists devices, the exit status is 4; other verbs use the devices of known drivers.",
    "The first time that a device with its driver is used, a small scene with known path lengths is rendered on it. "
    "A device that computes wrongly is refused. --test repeats this for every device and for all kernels, and prints a "
    "table; the results are kept in SKG_CACHE_DIR. Compiling all kernels may take minutes. The exit status is 1 if a "
    "device computes wrongly or its driver fails.",
    "--device driver=PATH, or SKG_DEVICE=driver=PATH, also lists the devices of a driver that is not installed, such as that of "
    "the Python package pocl-binary-distribution. PATH is the driver's library, which a file *.icd names. No environment variable "
    "is needed or changed.",
    "If every device that may be chosen is refused, the list says why, device by device, and the exit status is 4.",
    "Then lists the environment variables that change how devices work.",
    "--json prints {devices: [{device, name, platform, known, kind, chosen, refused, ...}], environment, affinity}; with --warm, {device, "
    "warm: [{scene, seconds}]}; with --test, {devices: [{device, name, platform, driver, tests: [{name, verdict, seconds, "
    "score, reason}]}]}, where verdict is right, wrong, unsupported or failed.",
    NULL};

static const cli_flag *const flags[] = {&cli_flag_device, &devices_test,   &devices_warm, &cli_flag_json,
                                        &cli_flag_strict, &cli_flag_quiet, NULL};

static const cli_item examples[] = {
    {"skiagraph devices", "lists the devices"},
    {"skiagraph devices --device cpu", "shows which device \"cpu\" names"},
    {"skiagraph devices --device driver=/opt/pocl/lib/libpocl.so.2",
     "lists the devices of a driver that is not installed, too"},
    {"skiagraph devices --test", "tests all kernels on every device"},
    {"skiagraph devices --warm scenes/", "compiles what the scenes of a folder need, before a batch of jobs"},
    {NULL, NULL}};

const cli_manual cli_manual_devices = {.name = "devices",
                                       .operands = "",
                                       .summary = "what OpenCL offers, and what would be chosen",
                                       .text = text,
                                       .flags = flags,
                                       .examples = examples,
                                       .check = "with --test, a device computes wrongly or its driver fails",
                                       .has_device = 1};
