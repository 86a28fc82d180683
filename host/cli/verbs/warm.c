/* Compiles what scenes need, so that the jobs that follow find it in the driver's cache. Drivers compile a kernel when it
 * first runs, so each scene is rendered. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "manual/manual.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct {
    const char *config; /* of the device; NULL: not given */
    json_t *done;       /* of --json; NULL: prints */
    int first_failure;
} warming;

/* An image, and the path lengths of a part. */
static skg_status draw(skg_plan *plan, skg_output *output) {
    skg_job *job = NULL;
    skg_frame frame;
    skg_frame_init(&frame);
    skg_status status = skg_plan_image(plan, output);
    if (status != SKG_OK && status != SKG_RANGE) return status;
    skg_output lengths = *output;
    lengths.kind = SKG_OUTPUT_LENGTHS;
    status = skg_plan_submit(plan, 1, &frame, 1, &lengths, &job);
    if (status == SKG_OK) status = skg_job_wait(&job);
    return status == SKG_RANGE ? SKG_OK : status;
}

static int render(skg_context *context, const skg_setup *setup) {
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_view view;
    skg_plan_options options;
    skg_output output;
    int64_t channels = 1;
    skg_view_init(&view);
    skg_plan_options_init(&options);
    skg_output_init(&output);
    skg_status status = skg_setup_scene_get(setup, &scene);
    if (status == SKG_OK) status = skg_setup_spectrum_get(setup, &spectrum);
    if (status == SKG_OK) status = skg_setup_view_get(setup, &view);
    if (status == SKG_OK) status = skg_setup_options_get(setup, &options);
    if (status == SKG_OK) status = skg_plan_create(context, scene, &view, spectrum, &options, &plan);
    if (status == SKG_OK) status = skg_plan_channel_count(plan, &channels);
    if (status == SKG_OK) {
        const int twice = options.precision == SKG_PRECISION_DOUBLE;
        output.type = twice ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
        output.data = calloc((size_t)(view.columns * view.rows * channels), twice ? 8 : 4);
        if (output.data) status = draw(plan, &output);
    }
    const int exit_status = status != SKG_OK ? cli_fail(status)
                            : output.data    ? CLI_DONE
                                             : cli_error(CLI_DEVICE, "out of host memory for the image");
    free(output.data);
    skg_plan_release(&plan);
    return exit_status;
}

/* In a context of its own. */
static int render_file(const char *config, const char *path) {
    skg_context *context = NULL;
    skg_setup *setup = NULL;
    skg_status status = skg_context_create(config, &context);
    if (status == SKG_OK) status = skg_context_log_set(context, cli_log, NULL);
    if (status == SKG_OK) status = skg_setup_load(context, path, 0, NULL, &setup);
    const int exit_status = status == SKG_OK ? render(context, setup) : cli_fail(status);
    skg_setup_release(&setup);
    skg_context_release(&context);
    return exit_status;
}

static void warm_scene(warming *w, const char *path) {
    const double start = cli_now_ms();
    int exit_status = render_file(w->config, path);
    /* With PoCL, programs are kept when they are used the second time (context.h). */
    if (exit_status == CLI_DONE) exit_status = render_file(w->config, path);
    const double seconds = (cli_now_ms() - start) / 1000;
    if (exit_status != CLI_DONE) {
        if (w->first_failure == CLI_DONE) w->first_failure = exit_status;
    } else if (w->done) {
        json_array_append_new(w->done,
                              json_pack("{s:o, s:f}", "scene", cli_json_text(path), "seconds", seconds));
    } else if (!cli_is_quiet()) {
        printf("%s: ready after %.2f s\n", path, seconds);
    }
}

static int is_scene(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0;
}

static void warm_folder(warming *w, const char *folder) {
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, is_scene, alphasort);
    if (count <= 0)
        w->first_failure = count < 0 ? cli_error(CLI_INPUT, "%s: %s", folder, strerror(errno))
                                     : cli_error(CLI_INPUT, "%s: holds no scene files (.json)", folder);
    for (int n = 0; n < count; n++) {
        char path[4096];
        if (snprintf(path, sizeof path, "%s/%s", folder, entries[n]->d_name) < (int)sizeof path)
            warm_scene(w, path);
        free(entries[n]);
    }
    free(entries);
}

int cli_warm(const cli_arguments *arguments) {
    skg_device_info device;
    struct stat is;
    warming w = {0};
    skg_context *context = NULL;
    const int exit_status = cli_open_context(arguments, &context, &device);
    if (exit_status != CLI_DONE) return exit_status;
    skg_context_release(&context); /* only the name of its device was wanted */
    w.config = cli_value(arguments, "--device");
    if (cli_given(arguments, "--json")) w.done = json_array();
    const char *path;
    for (int n = 0; (path = cli_nth_value(arguments, "--warm", n)); n++) {
        if (stat(path, &is) == 0 && S_ISDIR(is.st_mode))
            warm_folder(&w, path);
        else
            warm_scene(&w, path);
    }
    if (w.first_failure != CLI_DONE) {
        json_decref(w.done);
        return w.first_failure;
    }
    return w.done ? cli_json_print(json_pack("{s:s, s:o}", "device", device.name, "warm", w.done)) : CLI_DONE;
}
