/* The manual of `reconstruct`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag reconstruct_output = {"-o", "FILE", "The volume to write, a .mha. Required.", NULL,
                                            CLI_NAMES_FILE};
static const cli_flag reconstruct_geometry = {
    "--geometry", "FILE",
    "The places of a point source and the detector for the projections of a stack or a folder: a .csv with a line each, which scan "
    "--geometry FILE.csv writes, or the .xtekct of a Nikon scanner.",
    NULL, CLI_NAMES_FILE};
static const cli_flag reconstruct_size = {
    "--size", "N",
    "The number of voxels along each side, 1 to 4096, of the edge of --voxel: fewer than the default, the number of columns of a "
    "projection, crop the volume about its middle, which is said where --voxel is not given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag reconstruct_voxel = {
    "--voxel", "MM",
    "The edge of a voxel in mm. The default is the step of the detector's columns, as it is seen at the axis.",
    NULL, CLI_NAMES_NOTHING};

/* In the order of SKG_FDK_FILTER_. */
static const cli_item filters[] = {{"ramp", "the band-limited ramp (the default)"},
                                   {"hann", "the ramp times a Hann window: less noise, less sharp"},
                                   {NULL, NULL}};
static const cli_flag reconstruct_filter = {"--filter", NULL, "The filter of the rows of the projections.",
                                            filters, CLI_NAMES_NOTHING};

/* In the order of SKG_FDK_TRUNCATION_. */
static const cli_item truncations[] = {
    {"none", "nothing (the default): a warning says how many rows are cut off"},
    {"extrapolate",
     "rows are continued as the projection of an ellipse that fits, else by their mirror image (Ohnesorge 2000)"},
    {NULL, NULL}};
static const cli_flag reconstruct_truncation = {"--truncation", NULL,
                                                "What is done about projections that the detector cuts off.",
                                                truncations, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Reconstructs a circular scan by the method of Feldkamp, Davis and Kress, to look at what the scan gives. "
    "Scans of less than a turn get Parker's weights, and a full turn of a displaced detector (half-fan) Wang's, which is said. An axis or a detector that leans so far that the method is wrong is refused.",
    "The scan is an .h5 or .nxs that `skiagraph scan` wrote; or, with --geometry, a stack (.mha, .mhd or .tif) or a folder of TIFFs "
    "(projection-00000.tif or NAME_0000.tif and so on); or the .xtekct of a Nikon scanner, which names its folder. Flat and dark fields are read beside a stack (scan-flats.mha) or in the "
    "folder (flat-00000.tif, NAME_flat_0000.tif); without them they are FlatField and Dark of the header or of scan.txt, which is refused where these say that pixels differ, or the WhiteLevel of the .xtekct.",
    "The volume holds attenuation coefficients in 1/cm. It is centred on the centre of rotation, and its axes are those "
    "of the scene.",
    "--json prints {projections, size, voxel_mm, range, displaced, covered_mm, truncated, along_mm, seconds, file}; range has the least and the largest value, "
    "truncated the share of the rows that are cut off, along_mm the range of the axis that the rows of all projections see.",
    NULL};

static const cli_flag *const flags[] = {&reconstruct_output, &reconstruct_geometry,
                                        &reconstruct_size,   &reconstruct_voxel,
                                        &reconstruct_filter, &reconstruct_truncation,
                                        &cli_flag_json,      &cli_flag_strict,
                                        &cli_flag_quiet,     NULL};

static const cli_item examples[] = {
    {"skiagraph reconstruct scan.h5 -o volume.mha --size 256 --filter hann", "writes 256 x 256 x 256 voxels"},
    {"skiagraph reconstruct scan.mha --geometry scan.csv -o volume.mha", "takes the poses from a table"},
    {"skiagraph reconstruct projections/ --geometry scan.csv -o volume.mha", "reads a folder of TIFFs"},
    {"skiagraph reconstruct turbine.xtekct -o volume.mha", "reads the scan of a Nikon scanner"},
    {NULL, NULL}};

const cli_manual cli_manual_reconstruct = {.name = "reconstruct",
                                           .operands = "SCAN",
                                           .required = "-o FILE",
                                           .summary = "a volume from the projections of a scan",
                                           .text = text,
                                           .least = 1,
                                           .most = 1,
                                           .names = CLI_NAMES_FILE,
                                           .flags = flags,
                                           .examples = examples};
