/* Manual of the verb image: its flags, text and examples. */
#include "manual/manual.h"

/* In the order of SKG_QUANTITY_. */
static const cli_item quantities[] = {{"energy", "keV per pixel (the default)"},
                                      {"fluence", "energy fluence, keV/mm2"},
                                      {"photons", "photons per pixel"},
                                      {"transmission", "I/I0"},
                                      {"attenuation", "-ln(I/I0)"},
                                      {NULL, NULL}};
const cli_flag cli_flag_image_quantity = {"--quantity", "NAME", "The quantity of the image.", quantities,
                                          CLI_NAMES_NOTHING};

/* In the order of SKG_DISPLAY_. */
static const cli_item displays[] = {{"radiograph", "-ln(I/I0): dense parts are white (the default)"},
                                    {"transmission", "I/I0: dense parts are dark"},
                                    {NULL, NULL}};
static const cli_flag image_display = {"--display", "CURVE", "The curve from quantity to grey of a .png.",
                                       displays, CLI_NAMES_NOTHING};

static const cli_flag image_bands = {
    "--bands", "KEV,KEV,...",
    "The edges of photon-counting bands, rising. Each band from one edge to the next is a channel.", NULL,
    CLI_NAMES_NOTHING};

/* In the order of SKG_BAND_WEIGHT_. */
static const cli_item weights[] = {{"photons", "every recorded photon counts 1 (the default)"},
                                   {"energy", "photons count by their recorded energy"},
                                   {NULL, NULL}};
static const cli_flag image_band_weight = {
    "--band-weight", "NAME",
    "How photons count in the transmission and attenuation of bands, in the place of BandWeight of the scene.",
    weights, CLI_NAMES_NOTHING};

static const cli_flag image_scatter = {
    "--scatter", "ERROR|histories=N",
    "Adds scattered photons, to a standard error of the scatter over its mean, such as 0.01, or with N histories. The "
    "flag overrides the accuracy of the scene's key Scatter.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag image_scatter_image = {
    "--scatter-image", "FILE",
    "The file for the scattered part of the image, in any format of -o, without noise and blur. Scatter is then simulated "
    "also without the key, with an error of 1 %.",
    NULL, CLI_NAMES_OUTPUT};
static const cli_flag image_scatter_sigma = {
    "--scatter-sigma", "FILE", "Likewise the file for the standard error of the scatter in each pixel.", NULL,
    CLI_NAMES_OUTPUT};
static const cli_flag image_mean = {
    "--mean", "FILE",
    "The file for the image that is expected, without noise and steps, in any format of -o.", NULL,
    CLI_NAMES_OUTPUT};
static const cli_flag image_variance = {
    "--variance", "FILE",
    "Likewise the file for the variance that noise gives to each pixel, in the square of the image's unit. The scene needs Noise, "
    "electronic noise or steps.",
    NULL, CLI_NAMES_OUTPUT};

static const cli_flag image_only = {
    "--only", "PART,...",
    "Only the parts with these labels, in which * stands for any text. What lies in a part that is left out lies in what that lay in; "
    "view and beam stay. May be repeated.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag image_without = {"--without", "PART,...", "All parts but these, likewise.", NULL,
                                       CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Computes one image and writes it to the file of every -o. A .png holds 16-bit grey levels through --display "
    "and --range. A .tif or .mha holds floats, or doubles with --precision double; a .dcm holds 65536 steps between the least and the largest value, and needs the program dump2dcm of DCMTK; a .mha also holds the "
    "detector's position.",
    "With --bands the image has one channel for each band: a .tif has a page for each, a .mha a component; a .png "
    "shows the first. Energy and fluence of a band are in keV; photons, transmission and attenuation count photons. "
    "A file appears whole or not at all.",
    "With --scatter, or the key Scatter in the scene, photons that the parts scatter are added before noise and blur. "
    "Images of an attenuation or a transmission have the scatter as a share of the flat field. --repeat then times frames "
    "of the same scene, whose scatter is computed once. A .png of the scatter follows its values linearly.",
    cli_text_meshes,
    "--json prints {frame_ms, first_ms, plan_ms, stages, range, window, files, scatter, plan}; times are in ms; range has the "
    "least and the largest value of each channel, and window what a .png shows as black and as white. scatter is null without "
    "scatter, otherwise {mean, ratio, sigma, histories, seconds, cosines, orders, kinds}: the mean over the detector, the mean "
    "over that of the primary, the standard error, the shares of one, two, and more interactions, and those of rayleigh and "
    "compton.",
    NULL};

static const cli_flag *const flags[] = {&cli_flag_output,
                                        &cli_flag_image_quantity,
                                        &image_bands,
                                        &image_band_weight,
                                        &image_scatter,
                                        &image_scatter_image,
                                        &image_scatter_sigma,
                                        &image_mean,
                                        &image_variance,
                                        &image_display,
                                        &cli_flag_range,
                                        &cli_flag_repeat,
                                        &cli_flag_meshes_material,
                                        &cli_flag_meshes_kvp,
                                        &cli_flag_meshes_kev,
                                        &cli_flag_meshes_filter,
                                        &cli_flag_meshes_from,
                                        &image_only,
                                        &image_without,
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
    {"skiagraph image bunny.stl --material Al --kvp 120 -o bunny.png",
     "writes a radiograph of a mesh, without a scene"},
    {"skiagraph image scene.json -o image.png", "writes a radiograph"},
    {"skiagraph image scene.json -o image.mha --quantity attenuation --precision double",
     "writes -ln(I/I0) as doubles"},
    {"skiagraph image scene.json -o bands.tif --bands 20,40,60", "writes two photon-counting channels"},
    {"skiagraph image scene.json --scatter 0.01 -o total.mha --scatter-image scatter.mha",
     "writes an image with scattered photons, and these alone"},
    {"skiagraph image scene.json --set Noise=true -o noisy.mha --mean mean.mha --variance variance.mha",
     "writes an image with noise, its mean and the variance of its pixels"},
    {"skiagraph image scene.json --repeat 100", "measures the times of 100 frames and writes nothing"},
    {NULL, NULL}};

const cli_manual cli_manual_image = {.name = "image",
                                     .operands = "SCENE|MESH...",
                                     .summary = "one X-ray image of a scene",
                                     .text = text,
                                     .least = 1,
                                     .most = -1,
                                     .names = CLI_NAMES_FILE,
                                     .flags = flags,
                                     .examples = examples,
                                     .has_device = 1};
