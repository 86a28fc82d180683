/* The manual of `breathe`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag breathe_output = {
    "-o", "DIR|FILE",
    "The folder of the frames, made if it does not exist; or the file of a film, .gif, .mp4 or .webm. With --phase or "
    "--at the file of the one picture: .png, .tif or .mha.",
    NULL, CLI_NAMES_FILE};
static const cli_flag breathe_seconds = {
    "--seconds", "T", "The length of the sequence in s. The default is one breath.", NULL, CLI_NAMES_NOTHING};
const cli_flag cli_flag_breathe_fps = {
    "--fps", "N",
    "The number of frames per second of the patient's time, which is also the rate of a film. The default is 30.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag breathe_phase = {
    "--phase", "P",
    "Makes one picture at this phase of the breath: from 0, end-inspiration, to below 1; 0.5 is about end-expiration. Events are "
    "left out: they happen at a time, and a phase comes back in every breath.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag breathe_at = {
    "--at", "T",
    "Makes one picture at this time in s, with the events until then. It equals the frame that a sequence has at "
    "this time.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag breathe_outline = {
    "--outline", "PARTS@P", "Draws the outlines that parts have at phase P, as ribs,diaphragm@0.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag breathe_meshes = {
    "--meshes", "DIR",
    "Writes, for every frame and every part that moves, a binary PLY file with the displacement of each vertex in "
    "mm to this folder.",
    NULL, CLI_NAMES_FOLDER};

static const char *const text[] = {
    "Moves the parts of a scene as its key Breathing says, or by the labels of the parts if it has none, and writes "
    "an image of each frame. All frames are shown over one range of -ln(I/I0).",
    "Before writing, the whole sequence is computed once to report the frames per second; the next pose is computed "
    "while the device makes an image. A frame is the same whether it is made alone or in a sequence.",
    "A film shows the grey levels of the frames in 8 bit. A .gif has each of them exactly; it is repeated for ever, and "
    "counts time in hundredths of a second, so that at 30 frames per second some frames last 3 and some 4 of them, and the "
    "whole as long as it should. It has at most 50 frames per second. Files .mp4 (H.264) and .webm (VP9) lose a little, and "
    "need the program ffmpeg; an odd number of columns or rows becomes even: the last one is repeated.",
    "--json prints {frames, frames_per_s, frame_ms, pose_ms, plan_ms, range, dose: {at, "
    "air_kerma_uGy, kap_uGy_cm2, detector_air_kerma_uGy}, plan}, and for a film {file}.",
    NULL};

static const cli_flag *const flags[] = {&breathe_output,
                                        &breathe_seconds,
                                        &cli_flag_breathe_fps,
                                        &breathe_phase,
                                        &breathe_at,
                                        &breathe_outline,
                                        &breathe_meshes,
                                        &cli_flag_range,
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

static const cli_item files[] = {
    {"DIR/frame-0000.png, ...", "the frames"},
    {"DIR/contact.png", "small pictures of up to 16 of them, side by side"},
    {"DIR/motion.csv", "volumes, displacements and density of the lungs, a line for each frame"},
    {"FILE.gif, FILE.mp4, FILE.webm", "the film, instead of the three above"},
    {NULL, NULL}};

static const cli_item examples[] = {
    {"skiagraph breathe thorax/thorax.json -o frames", "writes the frames of one breath"},
    {"skiagraph breathe thorax/thorax.json -o breath.gif --fps 20", "writes one breath as a film"},
    {"skiagraph breathe thorax/thorax.json -o inspired.png --phase 0 --outline ribs,diaphragm@0.5",
     "writes the thorax at end-inspiration with the outlines that it has at expiration"},
    {NULL, NULL}};

const cli_manual cli_manual_breathe = {.name = "breathe",
                                       .operands = "SCENE",
                                       .required = "-o DIR|FILE",
                                       .summary = "a scene that breathes, under fluoroscopy",
                                       .text = text,
                                       .least = 1,
                                       .most = 1,
                                       .names = CLI_NAMES_SCENE,
                                       .flags = flags,
                                       .files = files,
                                       .examples = examples,
                                       .has_device = 1};
