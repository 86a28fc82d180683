/* The verb `view`: a scene in the room, as a picture, a film or a page. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/progress.h"
#include "common/say.h"
#include "core/maths.h"
#include "film/film.h"
#include "view/pages.h"
#include "view/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Three numbers "X,Y,Z", or two "W,H". Returns 0 if the text is anything else. */
static int read_numbers(const char *text, int count, double *numbers) {
    for (int k = 0; k < count; k++) {
        char *end = NULL;
        numbers[k] = strtod(text, &end);
        if (end == text || !isfinite(numbers[k]) || *end != (k < count - 1 ? ',' : '\0')) return 0;
        text = end + 1;
    }
    return 1;
}

static int read_side(view_work *w) {
    const char *value = cli_value(w->arguments, "--from");
    double *from = w->look.from;
    int32_t from_detector = 0;
    if (!value) return CLI_DONE;
    if (read_numbers(value, 3, from) && (from[0] != 0 || from[1] != 0 || from[2] != 0)) {
        w->look.up[2] = 1;
        return CLI_DONE;
    }
    if (skg_side_get(value, from, &from_detector) != SKG_OK)
        return cli_error(CLI_USAGE, "--from %s, or a direction X,Y,Z such as 1,-1,0.5", skg_last_error());
    for (int k = 0; k < 3; k++) from[k] = from_detector ? -from[k] : from[k];
    w->look.up[fabs(from[2]) > 0.99 ? 1 : 2] = 1;
    return CLI_DONE;
}

static int read_size(view_work *w) {
    const char *value = cli_value(w->arguments, "--size");
    double size[2];
    w->look.columns = 1280, w->look.rows = 800;
    if (!value) return CLI_DONE;
    if (!read_numbers(value, 2, size) || size[0] != floor(size[0]) || size[1] != floor(size[1]) ||
        size[0] < 64 || size[1] < 64 || size[0] > SKG_LOOK_PIXELS_MAX || size[1] > SKG_LOOK_PIXELS_MAX)
        return cli_error(CLI_USAGE, "--size %s is not W,H, two whole numbers from 64 to %d", value,
                         SKG_LOOK_PIXELS_MAX);
    w->look.columns = (int64_t)size[0], w->look.rows = (int64_t)size[1];
    return CLI_DONE;
}

/* Kinds of output. */
static int is_page(const char *path) {
    return cli_has_extension(path, ".html");
}

static int is_picture(const char *path) {
    return cli_has_extension(path, ".png");
}

static int is_model(const char *path) {
    return cli_has_extension(path, ".glb");
}

static const char *nth_output(const view_work *w, int index) {
    return cli_nth_value(w->arguments, "-o", index);
}

static int has_output(const view_work *w, int (*is_kind)(const char *path)) {
    const char *path;
    for (int i = 0; (path = nth_output(w, i)); i++)
        if (is_kind(path)) return 1;
    return 0;
}

static int check_output(const view_work *w, const char *path) {
    const int is_moment = !isnan(w->phase) || !isnan(w->at);
    if (is_picture(path) && !isnan(w->seconds))
        return cli_error(CLI_USAGE, "-o %s: a picture has no --seconds; choose its moment by --phase or --at",
                         path);
    if (is_model(path) && !isnan(w->seconds))
        return cli_error(CLI_USAGE, "-o %s: a model has no --seconds; choose its moment by --phase or --at",
                         path);
    if (is_picture(path) || is_page(path) || is_model(path)) return cli_file_check(path);
    if (!film_is(path))
        return cli_error(CLI_USAGE, "-o %s: the extension is not .png, .html, .glb, .gif, .mp4 or .webm",
                         path);
    if (is_moment)
        return cli_error(CLI_USAGE, "-o %s: a film has more than one moment; leave out --phase and --at",
                         path);
    return film_check(path, w->fps);
}

static int read_time(view_work *w) {
    const char *path;
    w->fps = 30, w->seconds = (double)NAN;
    int exit_status = cli_number(w->arguments, "--fps", 1e-3, 1000, &w->fps);
    if (exit_status == CLI_DONE) exit_status = cli_number(w->arguments, "--seconds", 0.01, 1e5, &w->seconds);
    if (exit_status == CLI_DONE && !isnan(w->seconds) && (!isnan(w->phase) || !isnan(w->at)))
        return cli_error(CLI_USAGE,
                         "--seconds shows the breath, --phase and --at one moment of it; give one of them");
    for (int i = 0; exit_status == CLI_DONE && (path = nth_output(w, i)); i++)
        exit_status = check_output(w, path);
    return exit_status;
}

/* Reads "Z" or "Z@PART"; the part is found when the scene is there. */
static int read_zoom(view_work *w) {
    const char *value = cli_value(w->arguments, "--zoom");
    char *end = NULL;
    w->zoom = value ? strtod(value, &end) : (double)NAN;
    if (!value || (end != value && w->zoom >= 0.01 && w->zoom <= 1e4 && (*end == '\0' || *end == '@')))
        return CLI_DONE;
    return cli_error(CLI_USAGE,
                     "--zoom %s is neither a factor from 0.01 to 10000 nor one with a part, such as 8@needle",
                     value);
}

/* The eye stands where the ball around the box of the parts, or of one of them, fills the picture Z times. */
static int zoom(view_work *w) {
    static const double FIELD = 28 * SKG_PI / 180; /* of the eye, scene_picture.h */
    const char *part = w->zoom > 0 ? strchr(cli_value(w->arguments, "--zoom"), '@') : NULL;
    const double *low = w->places.low, *high = w->places.high;
    double radius = 0;
    int64_t id = 0;
    if (!(w->zoom > 0)) return CLI_DONE;
    const skg_status status = part ? skg_scene_part_find(w->session.scene, part + 1, &id) : SKG_OK;
    if (status != SKG_OK) return cli_fail(status);
    if (part) low = w->places.parts[id].low, high = w->places.parts[id].high;
    for (int k = 0; k < 3; k++) {
        w->middle[k] = 0.5 * (low[k] + high[k]);
        radius += 0.25 * (high[k] - low[k]) * (high[k] - low[k]);
    }
    w->look.target = w->middle;
    w->look.distance = sqrt(radius) / tan(FIELD / 2) / w->zoom;
    free(w->places.parts);
    w->places = (view_places){0};
    return view_find_places(&w->session, &w->look, &w->places);
}

static int read_flags(view_work *w) {
    w->phase = w->at = (double)NAN;
    skg_look_init(&w->look);
    w->look.orthographic = cli_given(w->arguments, "--orthographic");
    if (!cli_given(w->arguments, "-o"))
        return cli_error(CLI_USAGE, "view: no output is named; add -o FILE.png or -o FILE.html");
    w->sensitive = cli_given(w->arguments, "--sensitivity");
    if (w->sensitive && !has_output(w, is_page))
        return cli_error(CLI_USAGE, "view: --sensitivity colours the parts of a page; add -o FILE.html");
    int exit_status = read_side(w);
    if (exit_status == CLI_DONE) exit_status = read_size(w);
    if (exit_status == CLI_DONE) exit_status = read_zoom(w);
    const char *phase = cli_value(w->arguments, "--phase");
    if (exit_status == CLI_DONE && phase) exit_status = cli_phase("--phase", phase, &w->phase);
    if (exit_status == CLI_DONE) exit_status = cli_number(w->arguments, "--at", -1e9, 1e9, &w->at);
    if (exit_status == CLI_DONE && !isnan(w->phase) && !isnan(w->at))
        return cli_error(CLI_USAGE, "--phase and --at both choose one moment; give one of them");
    return exit_status == CLI_DONE ? read_time(w) : exit_status;
}

/* A film lasts one breath unless --seconds is given. */
static int pose(view_work *w) {
    const int is_moving = has_output(w, film_is) || !isnan(w->seconds);
    double period = 0;
    if (!is_moving && isnan(w->phase) && isnan(w->at)) return CLI_DONE;
    skg_status status = skg_motion_create(w->session.context, w->session.setup, &w->motion);
    if (status == SKG_OK) status = skg_motion_period_get(w->motion, &period);
    if (status == SKG_OK && is_moving && isnan(w->seconds)) w->seconds = period;
    if (status == SKG_OK)
        status = isnan(w->phase) ? skg_motion_pose_at_time(w->motion, isnan(w->at) ? 0 : w->at)
                                 : skg_motion_pose_at_phase(w->motion, w->phase);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* The positions of the source in the scene's Scan, if it has one. */
static int find_path(view_work *w) {
    skg_scan *scan = NULL;
    int64_t count = 0;
    if (skg_setup_projection_count_get(w->session.setup, &count) != SKG_OK || count < 2 ||
        w->session.view.projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        return CLI_DONE;
    skg_status status = skg_setup_scan_get(w->session.setup, &scan);
    w->path = malloc((size_t)count * sizeof w->session.view.source);
    if (!w->path) return cli_error(CLI_DEVICE, "out of host memory for the scan");
    for (int64_t k = 0; k < count && status == SKG_OK; k++) {
        skg_view view;
        skg_view_init(&view);
        status = skg_scan_view_get(scan, k, &view);
        memcpy(w->path + 3 * k, view.source, sizeof view.source);
    }
    w->look.path = w->path, w->look.path_count = count;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int write_pictures(view_work *w) {
    unsigned char *bytes = NULL;
    const char *path;
    size_t count = 0;
    if (!has_output(w, is_picture)) return CLI_DONE;
    cli_progress_begin("drawing", 0);
    int exit_status = view_draw(w);
    if (exit_status == CLI_DONE) exit_status = view_encode(&w->look, w->rgba, &bytes, &count);
    cli_progress_end();
    if (exit_status == CLI_DONE) exit_status = view_sign(&bytes, &count);
    for (int i = 0; exit_status == CLI_DONE && (path = nth_output(w, i)); i++)
        if (is_picture(path)) exit_status = cli_write_file(path, bytes, count);
    free(bytes);
    return exit_status;
}

static int write_others(view_work *w) {
    const char *path;
    int exit_status = CLI_DONE;
    for (int i = 0; exit_status == CLI_DONE && (path = nth_output(w, i)); i++) {
        if (is_page(path)) exit_status = view_write_page(w, path);
        if (is_model(path)) exit_status = view_write_glb(w, path);
        if (film_is(path)) exit_status = view_write_film(w, path);
    }
    return exit_status;
}

/* Where the dot of a named part is; null if the part has no name in the picture. */
static json_t *dot_json(const view_work *w, const view_part *part) {
    for (int64_t i = 0; i < w->places.named_count; i++)
        if (w->places.named[i] == part) return cli_json_numbers(part->dot, 2);
    return json_null();
}

static json_t *parts_json(const view_work *w) {
    json_t *parts = json_array();
    uint8_t *colours = malloc((size_t)w->places.count * 4 + 1);
    if (!colours || skg_look_colours_get(w->session.scene, colours) != SKG_OK) {
        free(colours);
        return parts;
    }
    for (int64_t i = 0; i < w->places.count; i++) {
        const view_part *part = w->places.parts + i;
        json_t *object = json_object(), *colour = json_array();
        json_object_set_new(object, "label", cli_json_text(part->label));
        json_object_set_new(object, "column", cli_json_number(part->at[0]));
        json_object_set_new(object, "row", cli_json_number(part->at[1]));
        for (int k = 0; k < 4; k++) json_array_append_new(colour, json_integer(colours[4 * i + k]));
        json_object_set_new(object, "dot", dot_json(w, part));
        json_object_set_new(object, "colour", colour);
        json_array_append_new(parts, object);
    }
    free(colours);
    return parts;
}

static int print(const view_work *w) {
    const char *path;
    if (cli_given(w->arguments, "--json")) {
        json_t *object = json_object(), *files = json_array();
        for (int i = 0; (path = nth_output(w, i)); i++) json_array_append_new(files, cli_json_text(path));
        json_object_set_new(object, "files", files);
        json_object_set_new(object, "source_detector_mm", cli_json_number(w->places.source_detector));
        json_object_set_new(object, "source_object_mm", cli_json_number(w->places.source_object));
        json_object_set_new(object, "magnification", cli_json_number(w->places.magnification));
        json_object_set_new(object, "parts", parts_json(w));
        if (w->sensitive)
            json_object_set_new(object, "sensitivity", cli_sensitivity_json(&w->session, &w->sensitivity));
        return cli_json_print(object);
    }
    for (int i = 0; !cli_is_quiet() && (path = nth_output(w, i)); i++) cli_print("wrote %s\n", path);
    return CLI_DONE;
}

int cli_view(const cli_arguments *arguments) {
    view_work w = {.arguments = arguments};
    int exit_status = read_flags(&w);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 1, &w.session);
    w.look.collimation = w.session.options.collimation;
    if (exit_status == CLI_DONE) exit_status = pose(&w);
    if (exit_status == CLI_DONE) exit_status = view_make_image(&w);
    if (exit_status == CLI_DONE) exit_status = find_path(&w);
    if (exit_status == CLI_DONE) exit_status = view_find_places(&w.session, &w.look, &w.places);
    if (exit_status == CLI_DONE) exit_status = zoom(&w);
    if (exit_status == CLI_DONE) exit_status = view_find_sensitivity(&w);
    if (exit_status == CLI_DONE) exit_status = write_pictures(&w);
    if (exit_status == CLI_DONE) exit_status = write_others(&w);
    if (exit_status == CLI_DONE) exit_status = print(&w);
    free(w.places.parts);
    free(w.places.named);
    free(w.sensitivity.parts);
    free(w.values);
    free(w.image);
    free(w.rgba);
    free(w.path);
    skg_plan_release(&w.plan);
    skg_motion_release(&w.motion);
    cli_close_session(&w.session);
    return exit_status;
}
