/* The verb `register`: finds parts, or source and detector, from radiographs. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/say.h"
#include "register/work.h"

#include <stdlib.h>

static int check_outputs(const cli_arguments *arguments) {
    const char *scene = cli_value(arguments, "-o"), *page = cli_value(arguments, "--report");
    if (!scene)
        return cli_error(CLI_USAGE, "register: no file is named for the scene; add -o registered.json");
    if (!cli_has_extension(scene, ".json"))
        return cli_error(CLI_USAGE, "-o %s: a scene is written as .json", scene);
    if (page && !cli_has_extension(page, ".html"))
        return cli_error(CLI_USAGE, "--report %s: a page is written as .html", page);
    const int exit_status = cli_file_check(scene);
    return exit_status == CLI_DONE && page ? cli_file_check(page) : exit_status;
}

/* The scene with what was found: motions of parts, or views. */
static int write_scene(const register_work *work, const char *path) {
    const int64_t images = work->image_count;
    skg_setup_changes changes;
    skg_setup_changes_init(&changes);
    int64_t *parts = calloc((size_t)work->part_count, sizeof *parts),
            *projections = calloc((size_t)images, sizeof *projections);
    double *motions = calloc((size_t)work->part_count * 16, sizeof *motions);
    skg_view *views = calloc((size_t)images, sizeof *views);
    skg_status status = parts && projections && motions && views ? SKG_OK : SKG_ERR_MEMORY;
    for (int64_t p = 0; p < work->part_count && status == SKG_OK; p++) {
        if (!work->moved[p]) continue;
        for (int k = 0; k < 16; k++) motions[16 * changes.part_count + k] = work->motions[16 * p + k];
        parts[changes.part_count++] = p;
    }
    for (int64_t i = 0; i < images && status == SKG_OK && work->options.free != SKG_REGISTRATION_FREE_POSE;
         i++) {
        skg_view_init(&views[i]);
        status = skg_registration_view_get(work->last, i, &views[i]);
        projections[i] = work->images[i].projection;
        changes.view_count++;
    }
    changes.parts = parts, changes.motions = motions, changes.projections = projections,
    changes.views = views;
    if (status == SKG_OK) status = skg_setup_save(work->session.setup, &changes, path);
    free(parts);
    free(projections);
    free(motions);
    free(views);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int write_outputs(const register_work *work) {
    const char *scene = cli_value(work->arguments, "-o"), *page = cli_value(work->arguments, "--report");
    int exit_status = write_scene(work, scene);
    if (exit_status == CLI_DONE && page) exit_status = register_write_page(work, page);
    if (exit_status != CLI_DONE) return exit_status;
    if (cli_given(work->arguments, "--json")) return cli_json_print(register_json(work));
    if (cli_is_quiet()) return CLI_DONE;
    register_print(work);
    cli_print("wrote %s\n", scene);
    if (page) cli_print("wrote %s\n", page);
    return CLI_DONE;
}

static void close_work(register_work *work) {
    for (int64_t b = 0; b < work->body_count; b++) json_decref(work->bodies[b].directions);
    skg_registration_release(&work->last);
    register_free_images(work->image_count, work->images);
    free(work->bodies);
    free(work->motions);
    free(work->moved);
    cli_close_session(&work->session);
}

int cli_register(const cli_arguments *arguments) {
    register_work work = {.arguments = arguments, .named_by = "--image"};
    int exit_status = check_outputs(arguments);
    if (exit_status == CLI_DONE) exit_status = register_read_options(&work);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 0, &work.session);
    if (exit_status == CLI_DONE) exit_status = cli_refuse_counting(&work.session, "register");
    if (exit_status == CLI_DONE) exit_status = register_read_images(&work);
    if (exit_status == CLI_DONE) exit_status = register_run(&work);
    if (exit_status == CLI_DONE) exit_status = write_outputs(&work);
    if (exit_status == CLI_DONE &&
        work.bodies[work.body_count - 1].result.verdict == SKG_REGISTRATION_VERDICT_FAILED)
        exit_status = CLI_CHECK_FAILED;
    const int is_stopped = work.is_stopped;
    close_work(&work);
    if (exit_status == CLI_DONE && is_stopped) cli_end_by_signal();
    return exit_status;
}
