/* Shared work of the verb `view`: flags, scene, views. */
#include "view/picture.h"

#include "common/say.h"
#include "session/explain.h"

#include <math.h>
#include <stdlib.h>

/* The window of the first image holds for all that follow, so that a film does not flicker. */
static int find_window(view_work *w) {
    skg_picture picture;
    skg_picture_init(&picture);
    picture.columns = w->session.view.columns, picture.rows = w->session.view.rows;
    picture.data = w->values;
    picture.quantity = SKG_QUANTITY_ATTENUATION;
    const skg_status status = skg_picture_window_get(&picture, 0.005, 0.005, &w->low, &w->high);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static void show_image(view_work *w) {
    const int64_t pixels = w->session.view.columns * w->session.view.rows;
    if (!(w->high > w->low)) return; /* nothing to see: the detector stays plain */
    for (int64_t i = 0; i < pixels; i++) {
        const double grey = ((double)w->values[i] - w->low) / (w->high - w->low);
        w->image[i] = (uint8_t)(grey > 0 ? grey < 1 ? lround(255 * grey) : 255 : 0);
    }
    w->look.image = w->image;
}

static int make_plan(view_work *w) {
    const int64_t pixels = w->session.view.columns * w->session.view.rows;
    int64_t channels = 1;
    double plan_ms;
    w->session.options.quantity = SKG_QUANTITY_ATTENUATION;
    const int exit_status = cli_make_plan(&w->session, &w->plan, &plan_ms);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_plan_channel_count(w->plan, &channels);
    if (status != SKG_OK) return cli_fail(status);
    w->values = calloc((size_t)(pixels * channels), sizeof *w->values);
    w->image = malloc((size_t)pixels);
    return w->values && w->image ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory for the image");
}

int view_make_image(view_work *w) {
    skg_job *job = NULL;
    skg_output output;
    skg_frame frame;
    skg_output_init(&output);
    skg_frame_init(&frame);
    const int is_first = !w->plan;
    int exit_status = is_first ? make_plan(w) : CLI_DONE;
    if (exit_status != CLI_DONE) return exit_status;
    output.data = w->values;
    skg_status status = w->motion ? skg_motion_fill(w->motion, &frame) : SKG_OK;
    if (status == SKG_OK) status = skg_plan_submit(w->plan, 1, &frame, 1, &output, &job);
    if (job) status = skg_job_wait(&job);
    if (status != SKG_OK && status != SKG_RANGE) return cli_fail(status);
    if (is_first) exit_status = find_window(w);
    if (exit_status == CLI_DONE) show_image(w);
    return exit_status;
}

int view_pose_at(view_work *w, double time) {
    const skg_status status = skg_motion_pose_at_time(w->motion, time);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int view_draw(view_work *w) {
    if (!w->rgba) w->rgba = malloc((size_t)(4 * w->look.columns * w->look.rows));
    if (!w->rgba) return cli_error(CLI_DEVICE, "out of host memory for the picture");
    if (!w->places.named) {
        const int exit_status = view_choose_named(&w->session, &w->look, &w->places);
        if (exit_status != CLI_DONE) return exit_status;
    }
    const skg_status status =
        skg_scene_picture(w->session.context, w->session.scene, &w->session.view, &w->look, w->rgba);
    return status == SKG_OK ? view_label(&w->session, &w->look, &w->places, w->rgba) : cli_fail(status);
}
