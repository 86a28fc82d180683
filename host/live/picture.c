/* The 3D view as a transport draws it, for pages whose browser draws slowly. */
#include "live/plans.h"

#include "core/clock.h"
#include "core/text.h"

#include <skiagraph/scene_picture.h>

#include <math.h>
#include <string.h>

/* The head of a picture, in the order of the processor; [rows][columns][4] red, green, blue and 255 follow. */
typedef struct {
    char mark[4];           /* "SKLP" */
    uint32_t number;        /* of the look */
    uint16_t columns, rows; /* 0: it could not be drawn */
    float ms;
} header;

/* Storage of the arrays of a look. */
typedef struct {
    uint8_t *colours, *image, background[3];
    double *poses, box[6];
} arrays;

/* The colours of the library, and those of the look. */
static skg_status fill_colours(const skg_scene *scene, int64_t parts, const skg_live_eye *eye,
                               uint8_t *colours) {
    const char *key;
    json_t *colour;
    SKG_TRY(skg_look_colours_get(scene, colours));
    json_object_foreach(eye->colours, key, colour) {
        int64_t part = 0;
        if (!skg_live_part_read(key, &part) || part >= parts) continue;
        for (size_t k = 0; k < 4; k++)
            colours[4 * part + (int64_t)k] = (uint8_t)lround(json_number_value(json_array_get(colour, k)));
    }
    return SKG_OK;
}

/* The last image in the greys of the page. */
static void fill_image(const skg_live_plans *plans, const skg_live_eye *eye, uint8_t *image) {
    const double scale = eye->grey[1] != eye->grey[0] ? 255 / (eye->grey[1] - eye->grey[0]) : 0;
    const double flat = plans->header.flat_field;
    const int64_t count = plans->shown.columns * plans->shown.rows;
    const float *values = plans->values + plans->shown_channel * count;
    for (int64_t i = 0; i < count; i++) {
        const double value = (double)values[i], shown = flat > 0 ? -log(value / flat) : value;
        const double grey = (shown - eye->grey[0]) * scale;
        image[i] = (uint8_t)(grey > 0 ? grey < 255 ? grey + 0.5 : 255 : 0);
    }
}

static skg_status fill_arrays(skg_live_plans *plans, const skg_live_subject *subject,
                              const skg_live_message *wish, const skg_live_eye *eye, arrays *of) {
    int64_t parts = 0;
    SKG_TRY(skg_scene_part_count(subject->scene, &parts));
    SKG_TRY(skg_alloc(4 * parts + 1, 1, "colours", &of->colours));
    SKG_TRY(skg_alloc(16 * parts + 1, sizeof *of->poses, "poses", &of->poses));
    SKG_TRY(fill_colours(subject->scene, parts, eye, of->colours));
    SKG_TRY(skg_live_poses_get(subject, wish, of->poses));
    for (int k = 0; k < 3; k++) of->background[k] = (uint8_t)lround(eye->background[k]);
    if (!plans) return skg_live_box_get(subject, of->box);
    SKG_TRY(skg_live_box_find(plans, subject));
    memcpy(of->box, plans->box, sizeof of->box);
    if (!plans->is_shown) return SKG_OK;
    SKG_TRY(skg_alloc(plans->shown.columns * plans->shown.rows, 1, "image on the detector", &of->image));
    fill_image(plans, eye, of->image);
    return SKG_OK;
}

static skg_status draw(const skg_live_plans *plans, const skg_live_subject *subject, const skg_live_eye *eye,
                       const arrays *of, unsigned char *rgba) {
    const skg_view *view = plans && plans->is_shown ? &plans->shown : subject->shown;
    skg_look look;
    skg_look_init(&look);
    look.columns = eye->columns, look.rows = eye->rows;
    look.orthographic = eye->is_parallel;
    memcpy(look.from, eye->from, sizeof look.from);
    memcpy(look.up, eye->up, sizeof look.up);
    look.target = eye->target;
    look.distance = eye->distance;
    look.cut = eye->has_cut ? eye->cut : NULL;
    look.bounds = of->box;
    look.colours = of->colours, look.poses = of->poses, look.background = of->background;
    look.image = of->image;
    look.collimation = subject->options->collimation;
    return skg_scene_picture(subject->context, subject->scene, view, &look, rgba);
}

static skg_status need_look(const skg_live_message *look) {
    if (look && look->asked.kind == SKG_LIVE_ASKED_LOOK) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "live: the message is no look");
}

skg_status skg_live_picture_write(skg_live_plans *plans, const skg_live_subject *theirs,
                                  const skg_live_message *wish, const skg_live_message *look,
                                  skg_live_letter **letter) {
    SKG_PLAIN;
    const double start = skg_seconds();
    skg_live_subject subject;
    arrays of = {0};
    unsigned char *bytes = NULL;
    SKG_NEEDS(wish);
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_TRY(need_look(look));
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    const skg_live_eye *eye = &look->eye;
    SKG_TRY(skg_live_bytes_letter((int64_t)sizeof(header) + 4 * eye->columns * eye->rows, letter, &bytes));
    skg_status status = fill_arrays(plans, &subject, wish, eye, &of);
    if (status == SKG_OK) status = draw(plans, &subject, eye, &of, bytes + sizeof(header));
    const header head = {.mark = {'S', 'K', 'L', 'P'},
                         .number = (uint32_t)look->asked.number,
                         .columns = (uint16_t)eye->columns,
                         .rows = (uint16_t)eye->rows,
                         .ms = (float)(1000 * (skg_seconds() - start))};
    memcpy(bytes, &head, sizeof head);
    skg_free(&of.colours);
    skg_free(&of.poses);
    skg_free(&of.image);
    if (status != SKG_OK) skg_live_letter_release(letter);
    return status;
}

skg_status skg_live_picture_miss(const skg_live_message *look, skg_live_letter **letter) {
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_TRY(need_look(look));
    /* a time of nothing would be a picture that costs nothing */
    const header head = {.mark = {'S', 'K', 'L', 'P'}, .number = (uint32_t)look->asked.number, .ms = 1};
    return skg_live_letter_create(0, &head, sizeof head, letter);
}
