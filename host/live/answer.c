/* Answers to pages besides images: path lengths under the cursor, and files. */
#include "live/plans.h"

#include "core/maths.h"
#include "core/text.h"

#include <skiagraph/image.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* mm: what rounding leaves of a part that the ray misses is less. */
static const float LEAST_MM = 1e-4F;

/* The share of the pixels that a .png shows as black, and that it shows as white: those of `image`. */
static const double OUTSIDE = 0.005;

/* A detector of one pixel, which is that pixel of the view. */
static skg_status aim(const double at[2], skg_view *view) {
    if (!(at[0] >= 0 && at[0] < (double)view->columns && at[1] >= 0 && at[1] < (double)view->rows))
        return skg_fail(SKG_ERR_ARGUMENT, "\"probe\": the detector has no such pixel");
    const double column = floor(at[0]) + 0.5 - 0.5 * (double)view->columns,
                 row = floor(at[1]) + 0.5 - 0.5 * (double)view->rows;
    skg_add_scaled(view->centre, column, view->column_step, view->centre);
    skg_add_scaled(view->centre, row, view->row_step, view->centre);
    view->columns = view->rows = 1;
    return SKG_OK;
}

/* Renders with a plan of its own. */
static skg_status render(const skg_live_subject *subject, const skg_live_message *wish, const skg_view *view,
                         const skg_plan_options *options, int64_t count, const skg_output *outputs,
                         skg_plan **plan) {
    int is_dropped;
    SKG_TRY(skg_plan_create(subject->context, subject->scene, view, subject->spectrum, options, plan));
    const skg_live_rendering how = {.plan = *plan, .view = view, .outputs = outputs, .output_count = count};
    const skg_status status = skg_live_render(subject, wish, &how, &is_dropped);
    return status == SKG_RANGE ? SKG_OK : status;
}

static skg_status measure(const skg_live_subject *subject, const skg_live_message *wish, const skg_view *view,
                          int64_t parts, float *lengths) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output *outputs = NULL;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = subject->options->precision;
    SKG_TRY(skg_alloc(parts + 1, sizeof *outputs, "probe", &outputs));
    for (int64_t i = 0; i < parts; i++) {
        skg_output_init(outputs + i);
        outputs[i].kind = SKG_OUTPUT_LENGTHS;
        outputs[i].part = i;
        outputs[i].data = lengths + i;
    }
    const skg_status status = render(subject, wish, view, &options, parts, outputs, &plan);
    skg_plan_release(&plan);
    skg_free(&outputs);
    return status;
}

static json_t *list_parts(const skg_scene *scene, int64_t parts, const float *lengths) {
    json_t *list = json_array();
    for (int64_t i = 0; i < parts; i++) {
        const char *label = NULL;
        if (!(fabsf(lengths[i]) > LEAST_MM) || skg_scene_part_label_get(scene, i, &label) != SKG_OK) continue;
        json_array_append_new(list,
                              json_pack("[o,o]", skg_live_text(label), skg_live_number((double)lengths[i])));
    }
    return list;
}

skg_status skg_live_probe_write(const skg_live_subject *theirs, const skg_live_message *wish,
                                const skg_live_message *probe, skg_live_letter **letter) {
    SKG_PLAIN;
    skg_live_subject subject;
    float *lengths = NULL;
    int64_t parts = 0;
    SKG_NEEDS(wish);
    SKG_NEEDS(probe);
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    skg_view view = *subject.shown;
    SKG_TRY(aim(probe->asked.at, &view));
    SKG_TRY(skg_scene_part_count(subject.scene, &parts));
    SKG_TRY(skg_alloc(parts + 1, sizeof *lengths, "probe", &lengths));
    skg_status status = measure(&subject, wish, &view, parts, lengths);
    if (status == SKG_OK) {
        json_t *object = json_object();
        json_object_set_new(object, "probed", skg_live_numbers(probe->asked.at, 2));
        json_object_set_new(object, "parts", list_parts(subject.scene, parts, lengths));
        status = skg_live_text_letter(object, letter);
    }
    skg_free(&lengths);
    return status;
}

/* A message that has the name and the bytes of a file. */
static skg_status encode(const skg_picture *picture, const char *format, skg_live_letter **letter) {
    char name[32];
    int64_t whole = 0;
    unsigned char *bytes = NULL;
    const uint32_t length = (uint32_t)snprintf(name, sizeof name, "image.%s", format);
    SKG_TRY(skg_picture_encode(picture, name, NULL, 0, &whole));
    SKG_TRY(skg_live_bytes_letter(8 + (int64_t)length + whole, letter, &bytes));
    memcpy(bytes, "SKLB", 4);
    memcpy(bytes + 4, &length, 4);
    memcpy(bytes + 8, name, length);
    const skg_status status = skg_picture_encode(picture, name, bytes + 8 + length, whole, &whole);
    if (status != SKG_OK) skg_live_letter_release(letter);
    return status;
}

/* Names the channels of a plan in a picture. */
static skg_status name_channels(const skg_plan *plan, skg_channel *channels, const char **names,
                                skg_picture *picture) {
    for (int64_t c = 0; c < picture->channels; c++) {
        skg_channel_init(channels + c);
        SKG_TRY(skg_plan_channel_get(plan, c, channels + c));
        names[c] = channels[c].name;
    }
    picture->channel_names = names;
    picture->name = channels[0].name, picture->unit = channels[0].unit;
    picture->flat_field = channels[0].flat_field;
    return SKG_OK;
}

/* Makes the file's image. values: the caller frees them */
static skg_status write_file(const skg_live_subject *subject, const skg_live_message *wish,
                             const char *format, skg_plan **plan, float **values, skg_live_letter **letter) {
    const skg_view *view = subject->shown;
    skg_channel channels[SKG_CHANNELS_MAX];
    const char *names[SKG_CHANNELS_MAX];
    skg_plan_options options;
    skg_picture picture;
    skg_output output;
    int is_dropped;
    skg_picture_init(&picture);
    SKG_TRY(skg_live_options(subject, wish, &options));
    options.quantity = SKG_QUANTITY_ENERGY; /* what `image` shows unless it is asked for something else */
    SKG_TRY(skg_live_breathe(subject, wish));
    SKG_TRY(skg_plan_create(subject->context, subject->scene, view, subject->spectrum, &options, plan));
    SKG_TRY(skg_plan_channel_count(*plan, &picture.channels));
    SKG_TRY(skg_alloc(picture.channels * view->columns * view->rows, sizeof **values, "image", values));
    skg_output_init(&output);
    output.data = *values;
    const skg_live_rendering how = {.plan = *plan, .view = view, .outputs = &output, .output_count = 1};
    const skg_status status = skg_live_render(subject, wish, &how, &is_dropped);
    if (status != SKG_RANGE) SKG_TRY(status);
    picture.data = *values;
    picture.columns = view->columns, picture.rows = view->rows;
    picture.view = view;
    SKG_TRY(name_channels(*plan, channels, names, &picture));
    SKG_TRY(skg_picture_window_get(&picture, OUTSIDE, OUTSIDE, &picture.low, &picture.high));
    return encode(&picture, format, letter);
}

skg_status skg_live_file_write(const skg_live_subject *theirs, const skg_live_message *wish,
                               const skg_live_message *take, skg_live_letter **letter) {
    SKG_PLAIN;
    skg_live_subject subject;
    skg_plan *plan = NULL;
    float *values = NULL;
    SKG_NEEDS(wish);
    SKG_NEEDS(take);
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    const skg_status status = write_file(&subject, wish, take->asked.take, &plan, &values, letter);
    skg_free(&values);
    skg_plan_release(&plan);
    return status;
}
