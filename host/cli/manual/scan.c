/* Manual of the verb scan: its flags, text and examples. */
#include "manual/manual.h"

static const cli_flag scan_output = {
    "-o", "FILE",
    "The output: .h5 (HDF5 in the layout of Data Exchange, if it was built with HDF5), .nxs (the same as NXtomo, too), .mha (MetaImage), .raw (with its header in a .mhd beside it), .tif (BigTIFF), or a folder, which has no "
    "extension. Required.",
    NULL, CLI_NAMES_FILE};
static const cli_flag scan_from = {"--from", "K", "The first projection to compute, counted from 0.", NULL,
                                   CLI_NAMES_NOTHING};
static const cli_flag scan_to = {"--to", "K", "The last projection to compute.", NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_only = {"--only", "K,K,...", "Computes these projections only, in rising order.",
                                   NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_overwrite = {
    "--overwrite", NULL, "Replaces an output that holds another scan. Without this flag it is refused.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag scan_breathing = {
    "--breathing", NULL,
    "Poses the scene for each projection at its own time (Interval and StartTime of Scan), as its key Breathing says.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_phases = {
    "--phases", "N",
    "With --breathing: also writes the projections of each of N phases of the breath to a file of their own, when the scan "
    "is finished: scan.phase-K-of-N.h5 for -o scan.h5. Phase 1 is end-inspiration.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_dicom = {
    "--dicom", "DIR",
    "Also writes each projection as DIR/projection-00000.dcm when the scan is finished: Computed Radiography with the pixels' "
    "spacing, distances and voltage. Needs the program dump2dcm of DCMTK, and an output that is one file.",
    NULL, CLI_NAMES_FOLDER};
static const cli_flag scan_subframes = {
    "--subframes", "N",
    "Averages each projection from N frames, spread over its exposure (Exposure of Scan), during which the scan turns "
    "and the scene breathes. The default is 1.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_flats = {
    "--flats", "N",
    "The number of flat fields: the beam without parts. In an .h5 the default is 1. In a folder they are flat-00000.tif and on, and "
    "beside a .mha, .raw or .tif they are a stack, scan-flats.mha for scan.mha: both only with --flats, --darks or Flats or Darks of Scan, or where one FlatField and one Dark in the header are not enough (falloff, "
    "the heel effect, gains and the like). "
    "Geometry files name them in a comment.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_darks = {
    "--darks", "N",
    "The number of dark fields: no beam, but the electronic noise of the data. As --flats; "
    "dark-00000.tif, scan-darks.mha.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_shard = {
    "--shard", "I/N",
    "Computes block I of N blocks of consecutive projections, I from 1 to N, and writes it to a file of its own: "
    "scan.I-of-N.h5 for -o scan.h5. For job arrays.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_join = {
    "--join", NULL,
    "Puts the files of all shards together in the file of -o. Projections that no shard has are computed.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_mixed = {
    "--mixed", NULL,
    "Under MPI: allows devices that give different bits. Without this flag they are refused.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag scan_grey16 = {
    "--grey16", NULL,
    "Writes grey values of 16 bits: as GreyValues of the detector says, or 60000 where the free beam is strongest and 0 "
    "without radiation. Scenes with GreyValues, such as CTSimU scenarios, are written as grey values unless --quantity is "
    "given.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_packed = {
    "--packed", "FILE",
    "When the scan is finished: also writes the .h5 again to this .h5, compressed in chunks, without loss. May be given later, "
    "with the same command.",
    NULL, CLI_NAMES_FILE};
static const cli_flag scan_packed_grey16 = {
    "--packed-grey16", NULL,
    "With --packed: the copy has grey values of 16 bits, 60000 where the mean flat field is strongest.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag scan_verify = {
    "--verify", NULL,
    "Computes nothing: reads the projections of the output and compares them with their checksums. Damaged ones are marked as "
    "missing, so that the same command without --verify computes them again. The exit status is 1 if one is damaged or "
    "missing.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag scan_geometry = {
    "--geometry", "FILE",
    "Writes where source and detector are in each projection: .csv (a table, which Scan.Table reads and which is the "
    "cone_vec of ASTRA), .xml (RTK), .tigre.py (TIGRE), .cil.py (CIL) or transforms.json (NeRF, Gaussian splatting). A .ctsimu.json gets the scene itself as a CTSimU scenario, with "
    "meshes and spectrum in files beside it; a warning names what a scenario does not hold. May be repeated.",
    NULL, CLI_NAMES_FILE};

static const char *const text[] = {
    "Computes the projections of the scene's key Scan and writes them while the next ones are computed. "
    "While a scan is written, FILE.progress holds which projections are finished (an .h5 holds it itself). If the command is stopped, even by "
    "force, the same command continues with the projections that are missing. The bytes of the output do not depend on "
    "that. With each projection its checksum (CRC-32C) is written. When an unfinished scan is continued, its projections are read, "
    "and damaged ones are computed again.",
    "SIGINT, SIGTERM, SIGHUP, SIGUSR1 and SIGXCPU, which job managers send before their limit, end the command after the "
    "projections under way; a second signal ends it at once, and under MPI the first one does.",
    "An output that is finished is left as it is. One that holds another scan is refused: a scan is another one if the "
    "scene, a file that it names, the quantity, the precision, the tolerance or the version differs.",
    "A CTSimU scenario is a scene, too. A folder then has its layout: NAME_0000.tif, NAME_flat_0000.tif, NAME_dark.tif and "
    "NAME_metadata.json, where NAME is that of the scenario's file.",
    "Under mpirun or srun the processes take projections in turn and write them to one output; each has its own device or "
    "its share of the cores.",
    "--json prints {projections, computed, found, finished, plan_ms, seconds, projections_per_s, hash, file, plan}: how "
    "many projections the scan has, how many were computed now, and how many the output had before.",
    NULL};

static const cli_flag *const flags[] = {&scan_output,        &cli_flag_image_quantity,
                                        &scan_from,          &scan_to,
                                        &scan_only,          &scan_overwrite,
                                        &scan_breathing,     &scan_phases,
                                        &scan_dicom,         &scan_subframes,
                                        &scan_geometry,      &scan_flats,
                                        &scan_darks,         &scan_shard,
                                        &scan_join,          &scan_mixed,
                                        &scan_grey16,        &scan_packed,
                                        &scan_packed_grey16, &scan_verify,
                                        &cli_flag_device,    &cli_flag_precision,
                                        &cli_flag_tolerance, &cli_flag_strategy,
                                        &cli_flag_set,       &cli_flag_lenient,
                                        &cli_flag_json,      &cli_flag_strict,
                                        &cli_flag_quiet,     NULL};

static const cli_item files[] = {{"FILE", "the projections"},
                                 {"FILE.progress", "which of them are finished; removed at the end"},
                                 {"FILE.lock", "who writes the scan; removed at the end"},
                                 {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph scan scene.json -o scan.mha", "writes all projections as a stack"},
    {"skiagraph scan scene.json -o scan.mha --quantity attenuation --geometry scan.xml",
     "writes what RTK reconstructs"},
    {"skiagraph scan thorax/thorax.json --breathing -o folder --set "
     "Scan='{\"NumberOfProjections\":60,\"FinalAngle\":360,\"Interval\":0.1}'",
     "writes a thorax that breathes during the scan"},
    {"mpirun -n 8 skiagraph scan scene.json -o scan.h5", "shares the projections out over eight processes"},
    {NULL, NULL}};

const cli_manual cli_manual_scan = {.name = "scan",
                                    .operands = "SCENE",
                                    .required = "-o FILE",
                                    .summary = "the projections of a CT scan",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_SCENE,
                                    .flags = flags,
                                    .files = files,
                                    .examples = examples,
                                    .has_device = 1,
                                    .checks_outputs = 1};
