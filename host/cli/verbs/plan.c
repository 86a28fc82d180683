/* The verb `plan`: what a scene calls for, and why. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/say.h"
#include "session/explain.h"

#include <stdlib.h>

/* Computes one frame: the plan reports triangles per tile, pixels and stages of its last frame. */
static int measure(skg_plan *plan, const skg_view *view) {
    int64_t channels = 1;
    skg_output output;
    skg_output_init(&output);
    skg_status status = skg_plan_channel_count(plan, &channels);
    if (status != SKG_OK) return cli_fail(status);
    output.data = calloc((size_t)(view->columns * view->rows * channels), sizeof(float));
    if (!output.data) return cli_error(CLI_DEVICE, "out of host memory for the image");
    status = skg_plan_image(plan, &output);
    free(output.data);
    return status == SKG_OK || status == SKG_RANGE ? CLI_DONE : cli_fail(status);
}

int cli_plan(const cli_arguments *arguments) {
    cli_session session;
    skg_plan *plan = NULL;
    cli_prediction prediction;
    double plan_ms;
    int exit_status = cli_open_session(arguments, 0, &session);
    session.options.profile = 1;
    if (exit_status == CLI_DONE) exit_status = cli_make_plan(&session, &plan, &plan_ms);
    if (exit_status == CLI_DONE) exit_status = measure(plan, &session.view);
    if (exit_status == CLI_DONE) cli_predict(plan, session.options.tolerance, &prediction);
    if (exit_status == CLI_DONE && cli_given(arguments, "--json")) {
        json_t *object = cli_explain_json(plan, &session);
        json_object_set_new(object, "scatter", cli_prediction_json(&prediction));
        exit_status = cli_json_print(object);
    } else if (exit_status == CLI_DONE && !cli_is_quiet()) {
        cli_explain_print(plan, &session, &prediction);
    }
    skg_plan_release(&plan);
    cli_close_session(&session);
    return exit_status;
}
