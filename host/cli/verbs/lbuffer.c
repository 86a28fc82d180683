/* The verb `lbuffer`: path lengths through a part. */
#include "verbs/verbs.h"

#include "common/say.h"
#include "session/meshes.h"
#include "session/render.h"

typedef struct {
    int64_t part;
    int32_t kind;
} wanted_lengths;

static skg_status one_buffer(skg_plan *plan, const skg_output *output, const void *user) {
    const wanted_lengths *wanted = user;
    skg_job *job = NULL;
    skg_frame frame;
    skg_frame_init(&frame);
    skg_output lengths = *output;
    lengths.kind = SKG_OUTPUT_LENGTHS;
    lengths.part = wanted->part;
    lengths.lengths = wanted->kind;
    skg_status status = skg_plan_submit(plan, 1, &frame, 1, &lengths, &job);
    return status == SKG_OK ? skg_job_wait(&job) : status;
}

int cli_lbuffer(const cli_arguments *arguments) {
    wanted_lengths wanted = {0, cli_given(arguments, "--surface") ? SKG_LENGTHS_SURFACE : SKG_LENGTHS_NET};
    cli_rendering rendering = {
        .arguments = arguments, .frame = one_buffer, .frame_user = &wanted, .lengths = 1};
    const char *label = cli_value(arguments, "--part");
    const int is_one_mesh = cli_has_meshes(arguments) && arguments->operand_count == 1;
    if (!label && !is_one_mesh) return cli_error(CLI_USAGE, "lbuffer: no part is named; add --part LABEL");
    int exit_status = cli_check_outputs(arguments);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 1, &rendering.session);
    if (exit_status == CLI_DONE && label) {
        skg_status status = skg_scene_part_find(rendering.session.scene, label, &wanted.part);
        if (status != SKG_OK) exit_status = cli_fail(status);
    }
    if (exit_status == CLI_DONE) {
        rendering.session.options.scatter = NULL; /* lengths have none, and it is not for every scene */
        skg_picture_init(&rendering.picture);
        rendering.picture.name = "path length";
        rendering.picture.unit = "mm";
        exit_status = cli_render(&rendering);
    }
    cli_close_session(&rendering.session);
    return exit_status;
}
