/* Reads what a fit needs: scene, surfaces, flags. */
#include "fit/work.h"

#include "common/file.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int fit_load_scene(const cli_arguments *arguments, const char *path, int with_settings, skg_setup **setup) {
    int count = 0;
    const char **settings = calloc((size_t)arguments->given_count + 1, sizeof *settings);
    if (!settings) return cli_error(CLI_DEVICE, "out of host memory");
    for (const char *set; with_settings && (set = cli_nth_value(arguments, "--set", count)); count++)
        settings[count] = set;
    skg_setup_source source;
    skg_setup_source_init(&source);
    source.path = path;
    source.settings = settings;
    source.setting_count = count;
    source.lenient = cli_given(arguments, "--lenient");
    if (with_settings) source.log = cli_log; /* the fitted scene would repeat them */
    const skg_status status = skg_setup_create(NULL, &source, setup);
    free(settings);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

const char *fit_output(const fit_work *work, const char *extension) {
    const char *path;
    for (int i = 0; (path = cli_nth_value(work->arguments, "-o", i)); i++)
        if (cli_has_extension(path, extension)) return path;
    return NULL;
}

/* Checks before the search that every output has a known extension and can be written. */
static int check_outputs(const fit_work *work) {
    const char *path;
    int exit_status = CLI_DONE;
    for (int i = 0; exit_status == CLI_DONE && (path = cli_nth_value(work->arguments, "-o", i)); i++) {
        if (!cli_has_extension(path, ".json") && !cli_has_extension(path, ".html") &&
            !cli_has_extension(path, ".csv") && !cli_has_extension(path, ".png"))
            return cli_error(CLI_USAGE, "-o %s: its extension is none of .json, .html, .csv and .png", path);
        exit_status = cli_file_check(path);
    }
    if (exit_status == CLI_DONE && !fit_output(work, ".json"))
        return cli_error(CLI_USAGE, "fit: no file is named for the fitted scene; add -o fitted.json");
    return exit_status;
}

/* The number of the part that the word before "=" names. */
static int find_part(const fit_work *work, const char *word, size_t length, int64_t *part) {
    int64_t count = 0;
    const char *labels[512], *nearest;
    char name[256];
    skg_status status = skg_scene_part_count(work->scene, &count);
    snprintf(name, sizeof name, "%.*s", (int)length, word);
    for (int64_t p = 0; p < count && status == SKG_OK; p++) {
        skg_part one;
        skg_part_init(&one);
        status = skg_scene_part_get(work->scene, p, &one);
        if (status != SKG_OK) break;
        if (p < 512) labels[p] = one.label;
        if (!skg_same_name(one.label, name)) continue;
        *part = p;
        return CLI_DONE;
    }
    if (status != SKG_OK) return cli_fail(status);
    nearest = skg_nearest_name(name, labels, count < 512 ? count : 512);
    return cli_error(CLI_USAGE, "--target %s: the scene has no part \"%s\"%s%s%s", word, name,
                     nearest ? "; did you mean " : "", nearest ? nearest : "", nearest ? "?" : "");
}

/* The middle of a mesh's box where its pose puts it, and the box's diagonal, mm. */
static skg_status find_box(const skg_mesh *mesh, const double *pose, double middle[3], double *diagonal) {
    skg_mesh_health health;
    double across[3];
    skg_mesh_health_init(&health);
    SKG_TRY(skg_mesh_health_get(mesh, &health));
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (health.bounds[k] + health.bounds[3 + k]);
        across[k] = health.bounds[3 + k] - health.bounds[k];
    }
    skg_pose_point(pose, middle, middle);
    *diagonal = skg_length(across) * cbrt(fabs(skg_pose_determinant(pose)));
    return SKG_OK;
}

/* Warns of a target that the breathing of its part hardly makes: of another unit, or of another place. The search would end somewhere. */
static skg_status warn_of_target(const fit_work *work, const char *word, int64_t number,
                                 const skg_mesh *mesh) {
    static const double MOST = 5; /* organs of people differ by less */
    static const double as_is[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1};
    double from[3], to[3], ours = 0, theirs = 0;
    skg_part part;
    skg_part_init(&part);
    SKG_TRY(skg_scene_part_get(work->scene, number, &part));
    SKG_TRY(find_box(part.mesh, part.pose, from, &ours));
    SKG_TRY(find_box(mesh, as_is, to, &theirs));
    if (theirs > MOST * ours || ours > MOST * theirs)
        cli_warn(
            "--target %s: its box has a diagonal of %.4g mm, that of the part one of %.4g mm; is --unit right?",
            word, theirs, ours);
    skg_add_scaled(to, -1, from, to);
    if (skg_length(to) > fmax(ours, theirs))
        cli_warn(
            "--target %s: it lies %.4g mm from the part, whose box has a diagonal of %.4g mm; are both of one unit "
            "and in one system of coordinates?",
            word, skg_length(to), ours);
    return SKG_OK;
}

static int add_target(fit_work *work, const char *word, double phase, double unit_mm) {
    const char *equals = strchr(word, '=');
    skg_mesh *mesh = NULL;
    int64_t part = 0;
    if (!equals || equals == word || !equals[1])
        return cli_error(CLI_USAGE, "--target %s: give PART=FILE, such as liver=liver.stl", word);
    const int exit_status = find_part(work, word, (size_t)(equals - word), &part);
    if (exit_status != CLI_DONE) return exit_status;
    skg_status status = skg_mesh_load(NULL, equals + 1, unit_mm, &mesh);
    if (status == SKG_OK) status = skg_fit_target_add(work->fit, part, phase, mesh);
    if (status == SKG_OK) status = warn_of_target(work, word, part, mesh);
    skg_mesh_release(&mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* A phase holds for the targets after it; the first also for those before it. */
static int add_targets(fit_work *work) {
    const cli_arguments *arguments = work->arguments;
    const char *first = cli_nth_value(arguments, "--phase", 0);
    double phase = 0, unit_mm = 1;
    if (!cli_given(arguments, "--target") || !first)
        return cli_error(CLI_USAGE,
                         "fit: give at least one target and its phase: --target liver=liver.stl --phase 0");
    int exit_status = cli_mesh_unit(arguments, &unit_mm);
    if (exit_status == CLI_DONE) exit_status = cli_phase("--phase", first, &phase);
    for (int i = 0; i < arguments->given_count && exit_status == CLI_DONE; i++) {
        const struct cli_given *given = arguments->given + i;
        if (strcmp(given->flag->name, "--phase") == 0)
            exit_status = cli_phase("--phase", given->value, &phase);
        if (strcmp(given->flag->name, "--target") == 0)
            exit_status = add_target(work, given->value, phase, unit_mm);
    }
    return exit_status;
}

/* A range of what is not fitted would have no effect. */
static int check_chosen(const fit_work *work, const char *value, const char *name) {
    int64_t count = 0;
    skg_status status = skg_fit_parameter_count(work->fit, &count);
    for (int64_t p = 0; p < count && status == SKG_OK; p++) {
        skg_fit_parameter one;
        skg_fit_parameter_init(&one);
        status = skg_fit_parameter_get(work->fit, p, &one);
        if (status == SKG_OK && !one.chosen && skg_same_name(one.name, name))
            return cli_error(
                CLI_USAGE,
                "--bounds %s: the parameter %s is not fitted; name it in --parameters, or leave its "
                "range out",
                value, one.name);
    }
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int set_bounds(fit_work *work) {
    const char *value;
    for (int i = 0; (value = cli_nth_value(work->arguments, "--bounds", i)); i++) {
        char name[64] = "", rest = 0;
        double low = 0, high = 0;
        if (sscanf(value, "%63[^=]=%lf:%lf%c", name, &low, &high, &rest) != 3)
            return cli_error(CLI_USAGE, "--bounds %s: give NAME=LOW:HIGH, such as tendon-z=-30:0", value);
        const skg_status status = skg_fit_bounds_set(work->fit, name, low, high);
        if (status != SKG_OK) return cli_fail(status);
        const int exit_status = check_chosen(work, value, name);
        if (exit_status != CLI_DONE) return exit_status;
    }
    return CLI_DONE;
}

int fit_prepare(fit_work *work) {
    const cli_arguments *arguments = work->arguments;
    const char *names = cli_value(arguments, "--parameters");
    skg_fit_options options;
    skg_fit_options_init(&options);
    options.progress = cli_progress();
    int exit_status = check_outputs(work);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--method", &options.method);
    if (exit_status == CLI_DONE)
        exit_status = cli_integer(arguments, "--evaluations", 1, 1000000000, &options.evaluations);
    if (exit_status == CLI_DONE) exit_status = cli_integer(arguments, "--seed", 0, INT64_MAX, &options.seed);
    if (exit_status == CLI_DONE)
        exit_status = fit_load_scene(arguments, arguments->operands[0], 1, &work->setup);
    if (exit_status != CLI_DONE) return exit_status;
    skg_status status = skg_setup_scene_get(work->setup, &work->scene);
    if (status == SKG_OK) status = skg_fit_create(NULL, work->setup, &options, &work->fit);
    if (status == SKG_OK && names) status = skg_fit_parameters_choose(work->fit, names);
    if (status != SKG_OK) return cli_fail(status);
    exit_status = set_bounds(work);
    return exit_status == CLI_DONE ? add_targets(work) : exit_status;
}
