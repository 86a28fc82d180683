/* The list of manuals, and those of `help` and `version`. */
#include "manual/manual.h"

const cli_manual *const cli_manuals[] = {&cli_manual_image,    &cli_manual_lbuffer,
                                         &cli_manual_plan,     &cli_manual_view,
                                         &cli_manual_live,     &cli_manual_cost,
                                         &cli_manual_parts,    &cli_manual_dose,
                                         &cli_manual_mesh,     &cli_manual_distance,
                                         &cli_manual_material, &cli_manual_beam,
                                         &cli_manual_devices,  &cli_manual_thorax,
                                         &cli_manual_make,     &cli_manual_breathe,
                                         &cli_manual_fit,      &cli_manual_register,
                                         &cli_manual_scan,     &cli_manual_reconstruct,
                                         &cli_manual_schema,   NULL};

const char cli_summary[] = "X-ray images of triangle meshes on any OpenCL device";

const char *const cli_text[] = {
    "Skiagraph computes X-ray images of triangle meshes on any OpenCL device, CPU or GPU, with no window system. It "
    "can move the meshes with the patient's breathing. Each of its functions is a verb.",
    "A SCENE is a JSON file in the schema of gVirtualXray (Source, Detector, Samples, Scan) with keys of "
    "Skiagraph's own, such as Parent, Precision, Tolerance, Breathing and Noise. The SCENE - is read from standard "
    "input.",
    "A file that exists beside an input, or in a folder below it, is overwritten only if skiagraph wrote it.",
    NULL};

const cli_item cli_other_verbs[] = {
    {"help", "this text, or that of a VERB; help keys: the keys of scene files"},
    {"version", "the version, and what it was built with (also --version; with --json as JSON)"},
    {NULL, NULL}};

const cli_item cli_exit_statuses[] = {
    {"0", "The work is done."},
    {"1", "A check failed."},
    {"2", "The command line is wrong."},
    {"3", "An input file cannot be read, or its contents are wrong."},
    {"4", "No device is available, the device failed, or memory is exhausted."},
    {"5", "An output could not be written."},
    {NULL, NULL}};

const cli_item cli_environment[] = {
    {"SKG_DEVICE", "The device to use if --device is not given, in the same words."},
    {"SKG_KERNEL_DIR",
     "A folder from which the kernels are read instead of those built in, for development."},
    {"SKG_CACHE_DIR",
     "The folder in which compiled kernels and the results of device tests are kept; none keeps nothing. If it is not "
     "set, it is skiagraph in XDG_CACHE_HOME, or .cache/skiagraph in HOME."},
    {"POCL_AFFINITY",
     "1 pins PoCL's threads to cores. If it is not set, skiagraph sets it where the process has all cores to itself."},
    {"POCL_CACHE_DIR", "The folder in which PoCL keeps compiled kernels."},
    {"POCL_MAX_PTHREAD_COUNT",
     "The largest number of PoCL's threads. If it is not set, skiagraph sets it where the process may run on some of the cores only."},
    {"OCL_ICD_VENDORS", "The folder in which the OpenCL loader finds the platforms."},
    {NULL, NULL}};
