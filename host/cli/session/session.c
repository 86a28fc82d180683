/* A device and the scene that was read for it. */
#include "session/session.h"

#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "core/text.h"
#include "session/meshes.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static int read_tolerance(const cli_arguments *arguments, char *setting, size_t size) {
    const char *value = cli_value(arguments, "--tolerance");
    char *end = NULL;
    if (!value) return CLI_DONE;
    double tolerance = strtod(value, &end);
    if (end == value || *end || !(tolerance >= 0 && tolerance < 1))
        return cli_error(CLI_USAGE, "--tolerance %s is not a relative error from 0 to below 1", value);
    snprintf(setting, size, "Tolerance=%.17g", tolerance);
    return CLI_DONE;
}

static int load_scene(const cli_arguments *arguments, const char *tolerance, int lengths_only,
                      cli_session *session) {
    int count = 0;
    const char **settings = calloc((size_t)arguments->given_count + 1, sizeof *settings);
    if (!settings) return cli_error(CLI_DEVICE, "out of host memory");
    for (const char *set; (set = cli_nth_value(arguments, "--set", count)); count++) settings[count] = set;
    if (*tolerance) settings[count++] = tolerance;
    session->path = arguments->operands[0];
    skg_setup_source source;
    skg_setup_source_init(&source);
    source.settings = settings;
    source.setting_count = count;
    char *text = NULL;
    skg_status status = SKG_OK;
    int exit_status = cli_has_meshes(arguments) ? cli_scene_of_meshes(arguments, &text) : CLI_DONE;
    source.text = text;
    if (!text) source.path = session->path;
    source.lenient = cli_given(arguments, "--lenient");
    source.lengths_only = lengths_only;
    cli_progress_begin("reading the scene", 0);
    if (exit_status == CLI_DONE) status = skg_setup_create(session->context, &source, &session->setup);
    cli_progress_end();
    free(settings);
    free(text);
    if (exit_status != CLI_DONE) return exit_status;
    if (status != SKG_OK) return cli_fail(status);
    exit_status = cli_check_files_kept(arguments, session->setup);
    if (exit_status != CLI_DONE) return exit_status;
    skg_view_init(&session->view);
    skg_plan_options_init(&session->options);
    status = skg_setup_scene_get(session->setup, &session->scene);
    if (status == SKG_OK) status = skg_setup_spectrum_get(session->setup, &session->spectrum);
    if (status == SKG_OK) status = skg_setup_view_get(session->setup, &session->view);
    if (status == SKG_OK) status = skg_setup_options_get(session->setup, &session->options);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int cli_refuse_counting(const cli_session *session, const char *what) {
    if (!session->options.counter) return CLI_DONE;
    return cli_error(CLI_USAGE,
                     "%s: %s is for detectors that integrate energy; leave Counting out of the Detector",
                     session->path ? session->path : "scene", what);
}

/* Reports the loaded scene with --verbose. */
static void tell_scene(const cli_session *session) {
    int64_t parts = 0, bins = 0;
    if (skg_scene_part_count(session->scene, &parts) != SKG_OK) return;
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_mesh_health health;
        const char *mesh = "", *material = "";
        skg_part_init(&part);
        skg_mesh_health_init(&health);
        if (skg_scene_part_get(session->scene, i, &part) != SKG_OK ||
            skg_mesh_name_get(part.mesh, &mesh) != SKG_OK ||
            skg_mesh_health_get(part.mesh, &health) != SKG_OK ||
            skg_material_name_get(part.material, &material) != SKG_OK)
            return;
        cli_tell("part %s: mesh %s of %" PRId64 " triangles, %s; material %s", part.label, mesh,
                 health.triangles, health.closed ? "closed" : "leaky", material);
    }
    if (skg_spectrum_bin_count(session->spectrum, &bins) == SKG_OK)
        cli_tell("beam of %" PRId64 " %s; detector of %" PRId64 " x %" PRId64 " pixels", bins,
                 skg_plural(bins, "energy", "energies"), session->view.columns, session->view.rows);
}

int cli_open_session(const cli_arguments *arguments, int lengths_only, cli_session *session) {
    char tolerance[64] = "";
    int32_t precision = -1, strategy = SKG_STRATEGY_AUTO;
    *session = (cli_session){0};
    int exit_status = cli_check_operands(arguments);
    if (exit_status == CLI_DONE) exit_status = read_tolerance(arguments, tolerance, sizeof tolerance);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--precision", &precision);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--strategy", &strategy);
    if (exit_status == CLI_DONE)
        exit_status = cli_open_context(arguments, &session->context, &session->device);
    if (exit_status == CLI_DONE)
        cli_tell("device %s, driver %s", session->device.name, session->device.driver);
    if (exit_status == CLI_DONE) exit_status = load_scene(arguments, tolerance, lengths_only, session);
    if (exit_status == CLI_DONE) tell_scene(session);
    if (precision >= 0) session->options.precision = precision;
    session->options.strategy = strategy;
    return exit_status;
}

void cli_note_no_noise(const cli_session *session) {
    int32_t absolute = 0;
    if (session->options.noise || session->view.projection != SKG_PROJECTION_POINT ||
        skg_spectrum_absolute_get(session->spectrum, &absolute) != SKG_OK || !absolute)
        return;
    cli_note(
        "mAs is given, so photons are counted absolutely; there is no noise, because the key Noise is not given");
}

void cli_close_session(cli_session *session) {
    skg_scene_release(&session->chosen);
    skg_setup_release(&session->setup);
    skg_context_release(&session->context);
}
