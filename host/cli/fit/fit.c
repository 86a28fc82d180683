/* The verb `fit`: fits a breathing body to surfaces that were observed. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "fit/work.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

/* Continues from the checkpoint, if there is one. */
static int resume(fit_work *work, const char *checkpoint) {
    if (!checkpoint || access(checkpoint, F_OK) != 0) return CLI_DONE;
    const skg_status status = skg_fit_checkpoint_load(work->fit, checkpoint);
    if (status != SKG_OK) return cli_fail(status);
    cli_note("continues from %s", checkpoint);
    return CLI_DONE;
}

static int search(fit_work *work) {
    const char *checkpoint = cli_value(work->arguments, "--checkpoint");
    const int exit_status = resume(work, checkpoint);
    if (exit_status != CLI_DONE) return exit_status;
    if (checkpoint) cli_keep("%s is kept; the same command continues from it", checkpoint);
    const double begin = cli_now_ms();
    skg_status status = SKG_OK;
    skg_fit_state_init(&work->state);
    cli_progress_follow("evaluations");
    while (status == SKG_OK && !work->state.done) {
        status = skg_fit_step(work->fit, &work->state);
        if (status == SKG_OK && checkpoint) status = skg_fit_checkpoint_save(work->fit, checkpoint);
    }
    cli_progress_begin("measuring what is left", 0);
    if (status == SKG_OK) status = skg_fit_finish(work->fit);
    cli_progress_end();
    work->seconds = (cli_now_ms() - begin) / 1000;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int write_outputs(const fit_work *work) {
    const char *csv = fit_output(work, ".csv"), *picture = fit_output(work, ".png"),
               *page = fit_output(work, ".html");
    const skg_status status = skg_fit_scene_save(work->fit, fit_output(work, ".json"));
    int exit_status = status == SKG_OK ? CLI_DONE : cli_fail(status);
    if (csv && exit_status == CLI_DONE) exit_status = fit_write_csv(work, csv);
    if (picture && exit_status == CLI_DONE) exit_status = fit_write_bars(work, picture);
    if (page && exit_status == CLI_DONE) exit_status = fit_write_page(work, page);
    return exit_status;
}

static int print(const fit_work *work) {
    const char *path;
    if (cli_given(work->arguments, "--json")) return cli_json_print(fit_json(work));
    if (cli_is_quiet()) return CLI_DONE;
    fit_print(work);
    for (int i = 0; (path = cli_nth_value(work->arguments, "-o", i)); i++) cli_print("wrote %s\n", path);
    return CLI_DONE;
}

int cli_fit(const cli_arguments *arguments) {
    fit_work work = {.arguments = arguments};
    cli_progress_begin("reading scene and targets", 0);
    int exit_status = fit_prepare(&work);
    cli_progress_end();
    if (exit_status == CLI_DONE) exit_status = search(&work);
    if (exit_status == CLI_DONE) exit_status = write_outputs(&work);
    if (exit_status == CLI_DONE) exit_status = print(&work);
    skg_fit_release(&work.fit);
    skg_setup_release(&work.setup);
    return exit_status;
}
