/* skiagraph lbuffer */
#include "render.h"

static const cli_flag flag_part = {"--part", "LABEL", "the sample whose path lengths are wanted"};
static const cli_flag flag_surface = {
    "--surface", NULL, "the length in the mesh itself; default: net, minus the parts inside it"};

typedef struct {
    int64_t part;
    int32_t kind;
} wanted_lengths;

static skg_status one_buffer(skg_plan *plan, const skg_output *output, const void *user) {
    const wanted_lengths *wanted = user;
    skg_job *job = NULL;
    skg_frame frame;
    skg_frame_init(&frame);
    skg_status status = skg_plan_lengths(plan, wanted->part, wanted->kind, 1, &frame, output, &job);
    return status == SKG_OK ? skg_job_wait(&job) : status;
}

static int run(const cli_arguments *arguments) {
    wanted_lengths wanted = {0, cli_given(arguments, &flag_surface) ? SKG_LENGTHS_SURFACE : SKG_LENGTHS_NET};
    cli_rendering rendering = {
        .arguments = arguments, .frame = one_buffer, .frame_user = &wanted, .lengths = 1};
    const char *label = cli_value(arguments, &flag_part);
    if (!label) return cli_error(CLI_USAGE, "lbuffer: of which part? add --part LABEL");
    int exit_status = cli_check_outputs(arguments);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, &rendering.session);
    if (exit_status == CLI_DONE) {
        skg_status status = skg_scene_find(rendering.session.scene, label, &wanted.part);
        if (status != SKG_OK) exit_status = cli_fail(status);
    }
    if (exit_status == CLI_DONE) {
        skg_picture_init(&rendering.picture);
        rendering.picture.name = "path length";
        rendering.picture.unit = "mm";
        exit_status = cli_render(&rendering);
    }
    cli_close_session(&rendering.session);
    return exit_status;
}

static const cli_flag *const flags[] = {&flag_part,          &cli_flag_output,   &flag_surface,
                                        &cli_flag_range,     &cli_flag_repeat,   &cli_flag_device,
                                        &cli_flag_precision, &cli_flag_strategy, &cli_flag_set,
                                        &cli_flag_json,      &cli_flag_quiet,    NULL};

const cli_verb cli_lbuffer = {
    "lbuffer",
    "SCENE",
    "path lengths through one part (the L-buffer)",
    "Writes the length in mm of every pixel's ray inside one part to every -o. A .png shows lengths from black\n"
    "(the least) to white (the largest), or over --range; .tif and .mha hold them as floats, or as doubles\n"
    "with --precision double.",
    1,
    1,
    flags,
    run};
