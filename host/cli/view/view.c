#include "view/view.h"

#include "common/file.h"
#include "common/json.h"
#include "common/progress.h"
#include "common/say.h"
#include "session/explain.h"
#include "view/labels.h"
#include "view/place.h"
#include "view/sign.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the flags ask for, and what is made of it. */
typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    skg_motion *motion;
    skg_look look;
    double phase, at; /* NaN: not given */
    uint8_t *image, *rgba;
    double *path;
    view_places places;
} view_work;

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
    static const struct {
        const char *name;
        double from[3], up[3];
    } sides[] = {
        {"front", {0, -1, 0}, {0, 0, 1}}, {"side", {1, 0, 0}, {0, 0, 1}}, {"top", {0, 0, 1}, {0, 1, 0}}};
    const char *value = cli_value(w->arguments, &cli_flag_view_from);
    if (!value) return CLI_DONE;
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
        if (strcmp(value, sides[i].name) == 0) {
            memcpy(w->look.from, sides[i].from, sizeof w->look.from);
            memcpy(w->look.up, sides[i].up, sizeof w->look.up);
            return CLI_DONE;
        }
    w->look.up[2] = 1;
    double *from = w->look.from;
    if (read_numbers(value, 3, from) && (from[0] != 0 || from[1] != 0 || from[2] != 0)) return CLI_DONE;
    return cli_error(CLI_USAGE,
                     "--from %s is neither front, side or top nor a direction X,Y,Z such as 1,-1,0.5", value);
}

static int read_size(view_work *w) {
    const char *value = cli_value(w->arguments, &cli_flag_view_size);
    double size[2];
    w->look.columns = 1280, w->look.rows = 800;
    if (!value) return CLI_DONE;
    if (!read_numbers(value, 2, size) || size[0] != floor(size[0]) || size[1] != floor(size[1]) ||
        size[0] < 64 || size[1] < 64 || size[0] > SKG_LOOK_MOST_PIXELS || size[1] > SKG_LOOK_MOST_PIXELS)
        return cli_error(CLI_USAGE, "--size %s is not W,H, two whole numbers from 64 to %d", value,
                         SKG_LOOK_MOST_PIXELS);
    w->look.columns = (int64_t)size[0], w->look.rows = (int64_t)size[1];
    return CLI_DONE;
}

static int read_flags(view_work *w) {
    const char *path;
    w->phase = w->at = (double)NAN;
    skg_look_init(&w->look);
    w->look.orthographic = cli_given(w->arguments, &cli_flag_view_orthographic);
    if (!cli_given(w->arguments, &cli_flag_view_output))
        return cli_error(CLI_USAGE, "view: no output is named; add -o FILE.png");
    for (int i = 0; (path = cli_nth_value(w->arguments, &cli_flag_view_output, i)); i++)
        if (!cli_has_extension(path, ".png"))
            return cli_error(CLI_USAGE, "-o %s: the extension is not .png", path);
    int exit_status = read_side(w);
    if (exit_status == CLI_DONE) exit_status = read_size(w);
    if (exit_status == CLI_DONE)
        exit_status = cli_number(w->arguments, &cli_flag_view_phase, -1e9, 1e9, &w->phase);
    if (exit_status == CLI_DONE) exit_status = cli_number(w->arguments, &cli_flag_view_at, -1e9, 1e9, &w->at);
    if (exit_status == CLI_DONE && !isnan(w->phase) && !isnan(w->at))
        return cli_error(CLI_USAGE, "--phase and --at both choose one moment; give one of them");
    return exit_status;
}

static int pose(view_work *w) {
    if (isnan(w->phase) && isnan(w->at)) return CLI_DONE;
    skg_status status = skg_motion_create(w->session.context, w->session.setup, &w->motion);
    if (status == SKG_OK)
        status = isnan(w->phase) ? skg_motion_pose_at_time(w->motion, w->at)
                                 : skg_motion_pose_at_phase(w->motion, w->phase);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* The scene's image as greys of the detector. */
static int show_image(view_work *w, const float *values) {
    const int64_t pixels = w->session.view.columns * w->session.view.rows;
    skg_picture picture;
    skg_picture_init(&picture);
    picture.columns = w->session.view.columns, picture.rows = w->session.view.rows;
    picture.data = values;
    picture.quantity = SKG_QUANTITY_ATTENUATION;
    double low = 0, high = 1;
    const skg_status status = skg_picture_window_get(&picture, 0.005, 0.005, &low, &high);
    if (status != SKG_OK) return cli_fail(status);
    if (!(high > low)) return CLI_DONE; /* nothing to see: the detector stays plain */
    for (int64_t i = 0; i < pixels; i++) {
        const double grey = ((double)values[i] - low) / (high - low);
        w->image[i] = (uint8_t)(grey > 0 ? grey < 1 ? lround(255 * grey) : 255 : 0);
    }
    w->look.image = w->image;
    return CLI_DONE;
}

static int make_image(view_work *w) {
    const int64_t pixels = w->session.view.columns * w->session.view.rows;
    skg_plan *plan = NULL;
    skg_job *job = NULL;
    int64_t channels = 1;
    double plan_ms;
    skg_output output;
    skg_frame frame;
    skg_output_init(&output);
    skg_frame_init(&frame);
    w->session.options.quantity = SKG_QUANTITY_ATTENUATION;
    int exit_status = cli_make_plan(&w->session, &plan, &plan_ms);
    skg_status status = exit_status == CLI_DONE ? skg_plan_channel_count(plan, &channels) : SKG_OK;
    float *values = calloc((size_t)(pixels * channels), sizeof *values);
    w->image = malloc((size_t)pixels);
    if (exit_status == CLI_DONE && (!values || !w->image))
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the image");
    output.data = values;
    if (exit_status == CLI_DONE && status == SKG_OK && w->motion) status = skg_motion_fill(w->motion, &frame);
    if (exit_status == CLI_DONE && status == SKG_OK) status = skg_plan_submit(plan, 1, &frame, &output, &job);
    if (job) status = skg_job_wait(&job);
    if (exit_status == CLI_DONE && status != SKG_OK && status != SKG_RANGE) exit_status = cli_fail(status);
    if (exit_status == CLI_DONE) exit_status = show_image(w, values);
    free(values);
    skg_plan_release(&plan);
    return exit_status;
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

static int write_files(view_work *w) {
    char *bytes = NULL;
    const char *path;
    size_t count = 0;
    int exit_status = view_label(&w->session, &w->look, &w->places, w->rgba, &bytes, &count);
    if (exit_status == CLI_DONE) exit_status = view_sign(&bytes, &count);
    for (int i = 0; exit_status == CLI_DONE && (path = cli_nth_value(w->arguments, &cli_flag_view_output, i));
         i++)
        exit_status = cli_write_file(path, bytes, count);
    free(bytes);
    return exit_status;
}

static int draw(view_work *w) {
    w->rgba = malloc((size_t)(4 * w->look.columns * w->look.rows));
    if (!w->rgba) return cli_error(CLI_DEVICE, "out of host memory for the picture");
    cli_progress_begin("drawing", 0);
    const skg_status status =
        skg_view_picture(w->session.context, w->session.scene, &w->session.view, &w->look, w->rgba);
    cli_progress_end();
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
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
        json_object_set_new(object, "colour", colour);
        json_array_append_new(parts, object);
    }
    free(colours);
    return parts;
}

static int print(const view_work *w) {
    const char *path;
    if (cli_given(w->arguments, &cli_flag_json)) {
        json_t *object = json_object(), *files = json_array();
        for (int i = 0; (path = cli_nth_value(w->arguments, &cli_flag_view_output, i)); i++)
            json_array_append_new(files, cli_json_text(path));
        json_object_set_new(object, "files", files);
        json_object_set_new(object, "source_detector_mm", cli_json_number(w->places.source_detector));
        json_object_set_new(object, "source_object_mm", cli_json_number(w->places.source_object));
        json_object_set_new(object, "magnification", cli_json_number(w->places.magnification));
        json_object_set_new(object, "parts", parts_json(w));
        return cli_json_print(object);
    }
    for (int i = 0; !cli_is_quiet() && (path = cli_nth_value(w->arguments, &cli_flag_view_output, i)); i++)
        printf("wrote %s\n", path);
    return CLI_DONE;
}

int cli_view(const cli_arguments *arguments) {
    view_work w = {.arguments = arguments};
    int exit_status = read_flags(&w);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 1, &w.session);
    if (exit_status == CLI_DONE) exit_status = pose(&w);
    if (exit_status == CLI_DONE) exit_status = make_image(&w);
    if (exit_status == CLI_DONE) exit_status = find_path(&w);
    if (exit_status == CLI_DONE) exit_status = view_find_places(&w.session, &w.look, &w.places);
    if (exit_status == CLI_DONE) exit_status = draw(&w);
    if (exit_status == CLI_DONE) exit_status = write_files(&w);
    if (exit_status == CLI_DONE) exit_status = print(&w);
    free(w.places.parts);
    free(w.image);
    free(w.rgba);
    free(w.path);
    skg_motion_release(&w.motion);
    cli_close_session(&w.session);
    return exit_status;
}
